// Tests of time-domain passivity with the energy of packets.
#include "haptic_node/safety/tdpa.h"

#include <catch2/catch.hpp>
#include <random>

using namespace tactus::haptic;
using Eigen::Vector3d;

namespace {

constexpr double kTdpaTick_s = 0.001;

DeviceMotion along_z(double v_m_s) { return {Vector3d(0, 0, v_m_s * kTdpaTick_s), Vector3d::Zero(), {}}; }

}  // namespace

TEST_CASE("A port alone returns no more energy than it got: the table of one port") {
  // Velocity of the hand, and the force of the hand on the port: the force on the hand is its opposite. Energies computed with
  // another program.
  const double v[] = {0.1, 0.1, 0.1, -0.1, -0.1}, port_N[] = {1, 1, 1, 2, 2}, energy_J[] = {1e-4, 2e-4, 3e-4, 1e-4, 0};
  const double damping[] = {0, 0, 0, 0, 10};
  TimeDomainPassivity tdpa;
  double last_N = 0;
  for (int i = 0; i < 5; ++i) {
    const Wrench shown = tdpa.control({Vector3d(0, 0, -port_N[i]), Vector3d::Zero()}, along_z(v[i]), kTdpaTick_s, tdpa.in_J());
    CHECK(tdpa.damping_N_s_m() == Approx(damping[i]).margin(1e-9));
    last_N = -shown.force_N.z();
    tdpa.observe(work_J(shown, along_z(v[i]), kTdpaTick_s));
    CHECK(tdpa.in_J() - tdpa.out_J() == Approx(energy_J[i]).margin(1e-12));
  }
  CHECK(last_N == Approx(1.0));
}

TEST_CASE("The hand receives at most the energy of the packets, and no force is reversed or raised") {
  std::mt19937 random(17);
  std::uniform_real_distribution<double> axis(-1, 1);
  for (int trial = 0; trial < 50; ++trial) {
    TimeDomainPassivity tdpa;
    double promised_J = 0;
    for (int i = 0; i < 2000; ++i) {
      const Vector3d v = 0.3 * Vector3d(axis(random), axis(random), axis(random));
      const DeviceMotion during{v * kTdpaTick_s, Vector3d::Zero(), {}};
      const Wrench wanted{5 * Vector3d(axis(random), axis(random), axis(random)), Vector3d::Zero()};
      if (i % 5 == 0) promised_J += 1e-4 * (1 + axis(random));
      const Wrench shown = tdpa.control(wanted, during, kTdpaTick_s, promised_J);
      REQUIRE(shown.force_N.norm() <= wanted.force_N.norm() + 1e-12);
      const double before = wanted.force_N.dot(v), after = shown.force_N.dot(v);
      REQUIRE(after >= std::min(0.0, before) - 1e-12);
      REQUIRE(after <= before + 1e-12);
      // The hand moves as expected, so the promise holds exactly; below the least speed the damper does not act.
      tdpa.observe(work_J(shown, during, kTdpaTick_s));
      if (v.norm() > TimeDomainPassivity::kMinSpeed_m_s) REQUIRE(tdpa.out_J() <= promised_J + 1e-9);
    }
    CHECK(tdpa.out_J() > 0.5 * promised_J);
  }
}

TEST_CASE("A packet with less energy than an earlier one does not take back its promise, and credit ends with an episode") {
  TimeDomainPassivity tdpa;
  tdpa.control({}, along_z(0.1), kTdpaTick_s, 0.01);
  tdpa.control({}, along_z(0.1), kTdpaTick_s, 0);
  CHECK(tdpa.received_J() == 0.01);
  const Wrench push{Vector3d(0, 0, 2), Vector3d::Zero()};
  CHECK(tdpa.control(push, along_z(0.1), kTdpaTick_s, 0.01).force_N == push.force_N);
  tdpa.forget_credit();
  CHECK(tdpa.control(push, along_z(0.1), kTdpaTick_s, 0.01).force_N.norm() < 1e-12);
  // A force that resists is left alone.
  CHECK(tdpa.control(push, along_z(-0.1), kTdpaTick_s, 0.01).force_N == push.force_N);
}

TEST_CASE("Torque and force share the energy of the packets") {
  TimeDomainPassivity tdpa;
  const DeviceMotion turning{Vector3d(0, 0, 1e-4), Vector3d(0, 1e-3, 0), {}};
  const Wrench push{Vector3d(0, 0, 2), Vector3d(0, 0.2, 0)};
  // 0.2 mJ of the force and 0.2 mJ of the torque are coming, and half of it was promised.
  const Wrench shown = tdpa.control(push, turning, kTdpaTick_s, 2e-4);
  CHECK(shown.force_N.z() == Approx(1));
  CHECK(shown.torque_N_m.y() == Approx(0.1));
}
