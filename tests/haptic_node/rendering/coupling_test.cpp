#include "haptic_node/rendering/coupling.h"

#include <catch2/catch.hpp>
#include <random>

#include "haptic_node/rendering/rigid_coupling.h"
#include "tests/haptic_node/support/world.h"

using namespace tactus::haptic;
using Eigen::Vector3d;

TEST_CASE("The gains satisfy all four stability conditions for every mass, delay and device") {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> u(0, 1);
  const auto log_between = [&](double low, double high) { return low * std::pow(high / low, u(random)); };
  for (int round = 0; round < 20000; ++round) {
    CouplingLimits limits;
    limits.device_mass_kg = log_between(0.01, 1);
    limits.device_damping_N_s_m = log_between(0.1, 50);
    const bool fixed = round % 4 == 0;
    const double m = fixed ? 1e9 : log_between(1e-4, 100), tau = log_between(1e-3, 0.05),
                 T = log_between(2.5e-4, 1e-2);
    const double surface_K = log_between(10, 1e6), surface_B = log_between(0.001, 100);
    const Gains g = coupling_gains(surface_K, surface_B, m, tau, T, limits);
    const double b = limits.device_damping_N_s_m, M = limits.device_mass_kg;
    const double rho = fixed ? 1 : m / (m + M), mu = rho * M;
    REQUIRE(g.stiffness_N_m > 0);
    REQUIRE(g.stiffness_N_m <= std::min(surface_K, limits.stiffness_limit_N_m) * 1.000001);
    REQUIRE(g.stiffness_N_m <= 2 * (b - g.damping_N_s_m) / T * 1.000001);
    if (!fixed) REQUIRE(g.stiffness_N_m <= 0.1 * m / (tau * tau) * 1.000001);
    REQUIRE(g.damping_N_s_m >= 0);
    REQUIRE(g.damping_N_s_m <= b / 2 * 1.000001);
    const double ratio = (g.damping_N_s_m + b * rho * rho) / (2 * std::sqrt(g.stiffness_N_m * mu));
    REQUIRE(ratio >= 0.7 * 0.999999);
  }
}

TEST_CASE("The coupling to a light body is soft, and softer with a longer delay") {
  const CouplingLimits limits;
  const double soft = coupling_gains(1e6, 0, 0.01, 0.003, 1e-3, limits).stiffness_N_m;
  CHECK(soft == Approx(0.1 * 0.01 / 9e-6).epsilon(0.002));
  CHECK(coupling_gains(1e6, 0, 0.01, 0.006, 1e-3, limits).stiffness_N_m == Approx(soft / 4).epsilon(0.005));
  CHECK(coupling_gains(1e6, 0, 1e9, 0.006, 1e-3, limits).stiffness_N_m > 5 * soft);
}

TEST_CASE("The loop delay is the recent peak of the age and decays slowly") {
  LoopDelay delay;
  CHECK(delay.value_s(0.001, 0.001) == Approx(0.002));
  delay.observe(0.004);
  delay.observe(0.001);
  CHECK(delay.value_s(0.001, 0.001) == Approx(0.006));
  for (int k = 0; k < 1000; ++k) delay.advance(0, 1e-3);
  CHECK(delay.value_s(0, 0) == Approx(0.004 * std::exp(-1)));
  delay.observe(1e9);
  CHECK(delay.value_s(0, 0) == Approx(0.1));
}

TEST_CASE("A shorter intended delay reduces the loop delay at once and keeps the rest") {
  LoopDelay delay;
  delay.observe(0.043);
  constexpr double kTolerance_s = 1e-5;  // accuracy of the mean after ten of its time constants
  for (int k = 0; k < 5000; ++k) delay.advance(0.043, 1e-3);
  CHECK(delay.value_s(0, 0) == Approx(0.043).margin(kTolerance_s));
  delay.reduce(0.04);
  CHECK(delay.value_s(0, 0) == Approx(0.003).margin(kTolerance_s));
  delay.reduce(0.04);
  CHECK(delay.value_s(0, 0) == 0);
  for (int k = 0; k < 5000; ++k) delay.advance(0.002, 1e-3);
  CHECK(delay.value_s(0, 0) == Approx(0.002).margin(kTolerance_s));
}

TEST_CASE("A held touch model counts as late by half of the hold time") {
  LoopDelay delay;
  const int held_ms = GENERATE(10, 33, 50);
  double mean = 0;
  for (int ms = 0; ms < 400 * held_ms; ++ms) {
    if (ms % held_ms == 0) delay.observe(0);
    delay.advance(1e-3 * (ms % held_ms), 1e-3);
    if (ms >= 399 * held_ms) mean += delay.value_s(0, 0) / held_ms;
  }
  CHECK(mean == Approx(0.5e-3 * (held_ms - 1)).epsilon(0.1));
}

TEST_CASE("Forces never pull and stay within the friction cone") {
  std::mt19937 random(6);
  std::normal_distribution<double> normal(0, 1);
  for (int round = 0; round < 2000; ++round) {
    std::vector<Surface> surfaces(3);
    for (Surface& s : surfaces) {
      s.normal = Vector3d(normal(random), normal(random), normal(random)).normalized();
      s.depth_m = std::max(0.0, 0.001 * normal(random));
      s.coupling_stiffness_N_m = 1000;
      s.coupling_damping_N_s_m = 5;
      s.friction_static = s.friction_dynamic = 0.5;
    }
    std::vector<Vector3d> forces(3);
    const Vector3d velocity = Vector3d(normal(random), normal(random), normal(random));
    coupling_forces(surfaces, 0.001 * Vector3d(normal(random), 0, 0), velocity, round % 2, forces);
    for (int i = 0; i < 3; ++i) {
      const double push = forces[i].dot(surfaces[i].normal);
      if (surfaces[i].depth_m <= 0) REQUIRE(forces[i].norm() == 0);
      // A shift that is not exactly tangential may tilt the tangential part by at most its own angle.
      REQUIRE(push >= -0.5 * 1e-9 - 0.5 * forces[i].norm());
    }
  }
}

TEST_CASE("The force of one wall is stiffness times depth minus damping times the speed away from it") {
  std::vector<Surface> wall(1);
  wall[0].depth_m = 0.002;
  wall[0].coupling_stiffness_N_m = 1000;
  wall[0].coupling_damping_N_s_m = 4;
  std::vector<Vector3d> force(1);
  coupling_forces(wall, Vector3d::Zero(), {0, 0, 0.1}, false, force);
  CHECK((force[0] - Vector3d(0, 0, 1.6)).norm() < 1e-12);
  wall[0].velocity = {0, 0, 0.1};
  coupling_forces(wall, Vector3d::Zero(), {0, 0, 0.1}, false, force);
  CHECK((force[0] - Vector3d(0, 0, 2)).norm() < 1e-12);
  wall[0].velocity.setZero();
  coupling_forces(wall, Vector3d::Zero(), {0, 0, 2}, false, force);
  CHECK(force[0].norm() == 0);
}

TEST_CASE("The stiffness of a wall is passive and uses 0.7 of what passivity and damping ratio allow, at any lag") {
  std::mt19937 random(9);
  std::uniform_real_distribution<double> u(0, 1);
  const auto log_between = [&](double low, double high) { return low * std::pow(high / low, u(random)); };
  for (int round = 0; round < 20000; ++round) {
    CouplingLimits limits;
    limits.device_damping_N_s_m = log_between(0.02, 20);
    limits.held_damping_N_s_m = kHeldDamping_N_s_m;
    const double T = log_between(2.5e-4, 0.02), delay = 0.03 * u(random), surface = log_between(50, 1000);
    const Gains g = coupling_gains(surface, 0, 1e10, 0.003, T, limits, delay);
    const double b = limits.device_damping_N_s_m, lag = T / 2 + delay;
    CAPTURE(b, T, delay, surface, g.stiffness_N_m, g.damping_N_s_m);
    REQUIRE(g.damping_N_s_m <= b / 2 * 1.000001);
    REQUIRE(g.stiffness_N_m <= (b - g.damping_N_s_m) / lag * 1.000001);
    const double ratio = (std::clamp(b - 0.05, 0.0, b / 2) + std::max(b, 3.7)) / 1.4;
    REQUIRE(g.stiffness_N_m >= 0.7 * std::min({surface, (b - g.damping_N_s_m) / lag, ratio * ratio / 0.1}) * 0.999);
    // The lag must not drive slow motion: at most 0.25 mJ for 0.005 m2/s.
    REQUIRE(g.stiffness_N_m * lag - g.damping_N_s_m <= 0.05 * 1.000001);
  }
}

TEST_CASE("A device that lags is coupled like a node that lags by as much") {
  const CouplingLimits limits;
  const Gains late = coupling_gains(1e6, 0, 1e10, 0.003, 0.001, limits, 0.02);
  CHECK(late.stiffness_N_m == Approx(0.8 * 5 / 0.0205));
  CHECK(coupling_gains(1e6, 0, 1e10, 0.003, 0.041, limits).stiffness_N_m == Approx(late.stiffness_N_m));
  CHECK(late.damping_N_s_m == Approx(5));
}

TEST_CASE("The rotational stiffness of a slow device is passive too, for any damping of both") {
  std::mt19937 random(10);
  std::uniform_real_distribution<double> u(0, 1);
  const auto log_between = [&](double low, double high) { return low * std::pow(high / low, u(random)); };
  for (int round = 0; round < 5000; ++round) {
    Settings s;
    s.stiffness_limit_N_m = log_between(20, 5000);
    s.device_damping_Ns_m = log_between(0.1, 50);
    s.device_turn_damping_Nms_rad = log_between(0.0005, 0.5);
    const double T = log_between(2.5e-4, 0.02), delay = 0.03 * u(random), lever = coupling_lever_m(s);
    const double stiffness = turning_limit_N_m(s, lever, T, delay) * lever * lever;
    const double b = s.device_turn_damping_Nms_rad;
    REQUIRE(stiffness > 0);
    REQUIRE(stiffness <= b / (T / 2 + delay));
  }
}
