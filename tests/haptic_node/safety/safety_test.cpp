#include "haptic_node/safety/safety.h"

#include <catch2/catch.hpp>
#include <limits>
#include <random>

#include "tests/haptic_node/support/tick.h"
#include "tests/haptic_node/support/world.h"

using namespace tactus;
using namespace tactus::haptic;
using namespace tactus::haptic::test;

namespace {
}

TEST_CASE("The force obeys its limits of magnitude and slew for any wanted force") {
  std::mt19937 random(9);
  std::normal_distribution<double> normal(0, 1);
  const SafetyLimits limits;
  Safety safety(limits);
  Vector3d last = Vector3d::Zero();
  for (int k = 0; k < 20000; ++k) {
    const double size = std::pow(10.0, 6 * normal(random));
    Vector3d wanted = size * Vector3d(normal(random), normal(random), normal(random));
    if (k % 50 == 0) wanted.x() = std::numeric_limits<double>::quiet_NaN();
    if (k % 70 == 0) wanted.y() = std::numeric_limits<double>::infinity();
    const Vector3d force = safety.limit(wanted, 1e-3 * Vector3d(normal(random), 0, 0), kDt);
    REQUIRE(force.allFinite());
    REQUIRE(force.norm() <= limits.force_N + 1e-9);
    REQUIRE(beyond_slew_N(force, last, limits.slew_N_s * kDt) <= 1e-9);
    last = force;
  }
}

TEST_CASE("The force is the wanted one times a factor of 0 to 1, at any slew limit") {
  // A part of an earlier force that stayed behind would push a hand that has turned back.
  std::mt19937 random(3);
  std::normal_distribution<double> normal(0, 1);
  for (const double slew_N_s : {10.0, 100.0, 2000.0}) {
    SafetyLimits limits;
    limits.slew_N_s = slew_N_s;
    limits.torque_slew_N_m_s = slew_N_s / 100;
    Safety safety(limits);
    Wrench wanted;
    for (int k = 0; k < 5000; ++k) {
      if (k % 20 == 0) wanted.force_N = 3 * Vector3d(normal(random), normal(random), normal(random));
      wanted.force_N += 0.3 * Vector3d(normal(random), normal(random), normal(random));
      wanted.torque_N_m = 0.02 * wanted.force_N.cross(Vector3d::UnitX());
      const Wrench w = safety.limit(wanted, Vector3d::Zero(), Vector3d::Zero(), kDt);
      const auto check = [](const Vector3d& force, const Vector3d& of) {
        REQUIRE(force.cross(of).norm() < 1e-9);
        REQUIRE(force.dot(of) >= 0);
        REQUIRE(force.norm() <= of.norm() + 1e-12);
      };
      check(w.force_N, wanted.force_N);
      check(w.torque_N_m, wanted.torque_N_m);
    }
  }
}

TEST_CASE("The force of the scene before goes to zero within 20 ms, beside the force of the next") {
  Safety safety(SafetyLimits{});
  for (int k = 0; k < 10; ++k) safety.limit({6, 0, 0}, Vector3d::Zero(), kDt);
  safety.release();
  Vector3d last(6, 0, 0);
  for (int k = 1; k <= 20; ++k) {
    const Vector3d force = safety.limit({0, 1, 0}, Vector3d::Zero(), kDt);
    CHECK(force.x() == Approx(6 * (1 - k / 20.0)).margin(1e-9));
    CHECK(safety.released().force_N.x() == Approx(force.x()));
    CHECK(force.y() == Approx(1));
    CHECK((force - last).norm() < 1.1);
    last = force;
  }
  safety.release();
  safety.begin_tick(host_ms(0));
  safety.begin_tick(host_ms(30));
  CHECK(safety.limit({0, 0, 0}, Vector3d::Zero(), kDt).norm() == 0);
}

TEST_CASE("A late tick does not cause a jump of the force") {
  Safety safety(SafetyLimits{});
  CHECK(safety.limit({100, 0, 0}, Vector3d::Zero(), 0.02).norm() == Approx(4));  // 2 N/ms for 2 ms
}

TEST_CASE("A force along the motion gives the hand at most the energy allowance and the constant power") {
  const SafetyLimits limits;
  Safety safety(limits);
  Vector3d moved = Vector3d::Zero();
  double given = 0;
  Vector3d force = Vector3d::Zero();
  for (int k = 1; k <= 10000; ++k) {
    given += force.dot(moved);
    force = safety.limit({8, 0, 0}, moved, kDt);
    moved = {1e-3, 0, 0};  // the hand moves away at 1 m/s with the force
    // In addition: the force of the tick that emptied the tank, 8 N times 1 mm.
    REQUIRE(given <= limits.energy_J + limits.power_W * k * kDt + 0.008 + 1e-9);
  }
  CHECK(safety.energy_J() == Approx(given));
  CHECK(force.norm() == Approx(limits.power_W / 1.0).epsilon(0.01));  // continuous 1 W at 1 m/s: 1 N
}

TEST_CASE("A passive wall is not limited") {
  Safety safety(SafetyLimits{});
  double x = 0;
  for (int k = 0; k < 20000; ++k) {
    // Pressing 7 mm into 1 N/mm and out again, three times a second.
    const double next = -0.007 * std::abs(std::sin(M_PI * 3 * k * kDt));
    const double wanted = -1000 * next;
    const Vector3d force = safety.limit({wanted, 0, 0}, {next - x, 0, 0}, kDt);
    x = next;
    REQUIRE(force.x() == Approx(wanted).margin(1e-9));
  }
}

TEST_CASE("A device that jumps does no work") {
  Safety safety(SafetyLimits{});
  safety.limit({8, 0, 0}, Vector3d::Zero(), kDt);
  safety.limit({8, 0, 0}, {1, 0, 0}, kDt);
  CHECK(safety.energy_J() == 0);
}

TEST_CASE("Alternating limits give the hand no more energy than the wider limits") {
  const SafetyLimits wide, narrow{3, 500, 0.05, 0.1};
  Safety safety(wide);
  Vector3d moved = Vector3d::Zero(), force = Vector3d::Zero();
  double given = 0;
  for (int k = 1; k <= 10000; ++k) {
    if (k % 20 == 0) safety.set_limits(k % 40 == 0 ? wide : narrow);
    given += force.dot(moved);
    const Vector3d next = safety.limit({8, 0, 0}, moved, kDt);
    REQUIRE(beyond_slew_N(next, force, wide.slew_N_s * kDt) <= 1e-9);
    force = next;
    moved = {1e-3, 0, 0};
    REQUIRE(given <= wide.energy_J + wide.power_W * k * kDt + 0.008 + 1e-9);
  }
}

TEST_CASE("The force starts at zero after the watchdog time of the device") {
  Safety safety(SafetyLimits{});
  const auto press = [&](double ms) {
    safety.begin_tick(host_ms(ms));
    return safety.limit({8, 0, 0}, Vector3d::Zero(), kDt).x();
  };
  CHECK(press(0) == Approx(2));
  CHECK(press(1) == Approx(4));
  CHECK(press(21) == Approx(6));
  CHECK(press(42) == Approx(2));
}

TEST_CASE("The fade goes to 0 from 50 to 70 ms after the last touch model and returns within 20 ms") {
  Fade fade(0.05, 0.02);
  CHECK(fade.step(host_ms(0), std::nullopt, kDt) == 0);
  CHECK(fade.lost());
  for (int ms = 1; ms <= 20; ++ms) CHECK(fade.step(host_ms(ms), host_ms(ms), kDt) == Approx(ms / 20.0));
  // The last one arrives at 20 ms.
  for (int ms = 21; ms <= 70; ++ms) {
    CHECK(fade.step(host_ms(ms), host_ms(20), kDt) == 1);
    CHECK_FALSE(fade.lost());
  }
  for (int ms = 71; ms <= 90; ++ms) {
    CHECK(fade.step(host_ms(ms), host_ms(20), kDt) == Approx(1 - (ms - 70) / 20.0).margin(1e-12));
    CHECK(fade.lost());
  }
  CHECK(fade.step(host_ms(500), host_ms(20), kDt) == 0);
  for (int ms = 501; ms <= 520; ++ms) CHECK(fade.step(host_ms(ms), host_ms(ms), kDt) == Approx((ms - 500) / 20.0));
}

TEST_CASE("The energy of a late device is that of the force that acted during its motion") {
  Safety safety(SafetyLimits{});
  for (int k = 0; k < 10; ++k) safety.limit({5, 0, 0}, Vector3d::Zero(), 1e-3);
  // The device felt 1 N when it moved by 20 mm in 20 ms, although 5 N are commanded now.
  safety.set_acting({Vector3d(1, 0, 0), Vector3d(0, 0.1, 0)}, 0.02);
  safety.limit({Vector3d(5, 0, 0), Vector3d::Zero()}, {0.02, 0, 0}, {0, 0.1, 0}, 1e-3);
  CHECK(safety.energy_J() == Approx(0.02 + 0.01));
  // It applies to one motion only.
  safety.limit({5, 0, 0}, {0.001, 0, 0}, 1e-3);
  CHECK(safety.energy_J() == Approx(0.035).margin(1e-4));
}

TEST_CASE("A slow tick has the whole slew of its period") {
  Settings settings;
  settings.rate_Hz = 100;
  Safety safety(safety_limits(settings));
  CHECK(safety.limit({8, 0, 0}, Vector3d::Zero(), 0.01).x() == 8);
}

TEST_CASE("The fade never changes faster than within its time, also when the arrivals end or the clock steps") {
  std::mt19937 random(5);
  Fade fade(0.05, 0.02);
  double last = 0;
  for (int k = 0; k < 5000; ++k) {
    std::optional<sync::HostTime> newest;
    if (k / 50 % 3 != 0) newest = host_ms(k + (random() % 200 == 0 ? 1000.0 : 0.0) - static_cast<double>(random() % 40));
    if (random() % 100 == 0) fade.restart();
    const double value = fade.step(host_ms(k), newest, kDt);
    REQUIRE(std::abs(value - last) <= 0.05 + 1e-12);
    REQUIRE(value >= 0);
    REQUIRE(value <= 1);
    last = value;
  }
  for (int k = 0; k < 20; ++k) fade.step(host_ms(k), host_ms(k + 51), kDt);
  CHECK(fade.lost());
  CHECK(fade.value() == 0);
}

TEST_CASE("After a restart the fade goes to zero before it returns") {
  Fade fade(0.05, 0.02);
  for (int ms = 0; ms < 30; ++ms) fade.step(host_ms(ms), host_ms(ms), kDt);
  fade.restart();
  for (int ms = 30; ms < 50; ++ms) {
    CHECK(fade.restarting());
    CHECK(fade.step(host_ms(ms), host_ms(ms), kDt) == Approx(1 - (ms - 29) / 20.0).margin(1e-9));
  }
  for (int ms = 50; ms < 70; ++ms)
    CHECK(fade.step(host_ms(ms), host_ms(ms), kDt) == Approx((ms - 49) / 20.0).margin(0.051));
}
