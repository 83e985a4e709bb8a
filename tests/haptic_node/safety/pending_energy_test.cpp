#include "haptic_node/safety/pending_energy.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <deque>
#include <functional>

#include "tests/haptic_node/support/tick.h"

using namespace tactus::haptic;
using Eigen::Vector3d;
using tactus::haptic::test::kDt;

namespace {

constexpr double kMax_N = 8;

// A body that a hand pushes down and other forces hold, and the estimate of the energy that it received, from
// reports that are some milliseconds late until they stop.
struct Pushed {
  double mass_kg;
  std::function<double(double t_s, double down_m_s)> others_N;  // upwards
  std::size_t late_ms = 0;
  int reported_until_ms = 1'000'000;
  double down_m_s = 0;

  double work_J = 0, impulse_N_s = 0;
  int ms = 0, age_ms = 0;
  PendingEnergyEstimator estimator{};
  struct Report {
    PendingEnergyEstimator::BodyReport report;
    double work_J;
  };
  std::deque<Report> in_transit{};
  double reported_J = 0;

  // Estimated minus true energy since the last report, J.
  double step(double push_N) {
    const double before = down_m_s;
    double next = before + (push_N - others_N(kDt * ms, before)) / mass_kg * kDt;
    if (before >= 0 && next < 0 && stops) next = 0;
    down_m_s = next;
    work_J += push_N * 0.5 * (before + next) * kDt;
    impulse_N_s += push_N * kDt;
    estimator.add_push({0, 0, -push_N}, kDt);
    ++ms;
    in_transit.push_back(
        {{ms * 1'000'000, mass_kg, Vector3d::UnitZ(), {0, 0, -down_m_s}, {0, 0, -impulse_N_s}}, work_J});
    ++age_ms;
    if (in_transit.size() > late_ms) {
      if (ms <= reported_until_ms) {
        estimator.on_report(in_transit.front().report, kMax_N);
        reported_J = in_transit.front().work_J;
        age_ms = static_cast<int>(late_ms);
      }
      in_transit.pop_front();
    }
    return estimator.energy_J(1e-3 * age_ms, kMax_N) - (work_J - reported_J);
  }
  bool stops = false;  // as friction does
};

double nothing(double, double) { return 0; }

}  // namespace

TEST_CASE("The estimate is exact for a free body at any report delay and push") {
  const std::size_t late_ms = GENERATE(1, 5, 25, 38);
  const double first_m_s = GENERATE(0.0, 0.2, -0.2);
  Pushed body{0.2, nothing, late_ms};
  body.down_m_s = first_m_s;
  CAPTURE(late_ms, first_m_s);
  for (int ms = 0; ms < 400; ++ms) {
    const double off_J = body.step(1 + std::sin(0.05 * ms));
    if (ms > static_cast<int>(late_ms)) CHECK(std::abs(off_J) < 1e-6);
  }
}

TEST_CASE("The holding force is estimated and used for a while after the last report") {
  // A slider with a friction of 0.5 N is pushed along with 0.6 N.
  Pushed body{0.05, [](double, double) { return 0.5; }, 2, 300};
  body.stops = true;
  double off_J = 0;
  for (int ms = 0; ms < 340; ++ms) {
    off_J = body.step(0.6);
    if (ms > 100) CHECK(std::abs(off_J) < 0.05 * 0.6 * body.down_m_s * 0.04);
  }
  SECTION("Later the body counts as free, and the estimate is never too low") {
    for (int ms = 0; ms < 60; ++ms) {
      const double next_J = body.step(0.6);
      CHECK(next_J >= off_J - 1e-9);
      off_J = next_J;
    }
    CHECK(off_J > 1e-3);
  }
}

TEST_CASE("A fading push acts on the speed that earlier pushes caused") {
  // Half of its impulse has passed when the holding force has done a quarter of its work: assuming halves of both
  // would give too low a value.
  for (const double held_N : {0.5, 1.0, 2.0}) {
    Pushed body{1, [&](double, double) { return held_N; }, 2, 200};
    body.stops = true;
    for (int ms = 0; ms < 200; ++ms) body.step(held_N);
    for (int ms = 0; ms < 60; ++ms) {
      const double off_J = body.step(4 * std::max(0.0, 1 - ms / 40.0));
      CHECK(off_J >= -1e-6);
      if (ms < 38) CHECK(off_J < 1e-6);
    }
  }
}

TEST_CASE("A body that is pulled away receives more energy than a free body") {
  // A swing on its way back: 2 N pull it down.
  Pushed body{1, [](double, double) { return -2.0; }, 2, 200};
  for (int ms = 0; ms < 200; ++ms) body.step(0.5);
  for (int ms = 0; ms < 38; ++ms) CHECK(std::abs(body.step(2)) < 2e-5);
  // Also without a report for a long time.
  for (int ms = 38; ms < 70; ++ms) CHECK(body.step(2) > -2e-5);
}

TEST_CASE("An approaching body gives at most its kinetic energy") {
  // A spring drives it towards the hand; the estimate must not assume that this continues.
  Pushed body{0.5, [](double, double) { return 3.0; }, 2, 200};
  body.down_m_s = 0;
  for (int ms = 0; ms < 200; ++ms) body.step(2);
  REQUIRE(body.down_m_s < -0.1);
  const double motion_J = 0.5 * 0.5 * body.down_m_s * body.down_m_s;
  for (int ms = 0; ms < 100; ++ms) {
    const double off_J = body.step(2);
    CHECK(off_J >= 0);
    CHECK(body.estimator.energy_J(1e-3 * body.age_ms, kMax_N) >= -motion_J);
  }
}

TEST_CASE("An approaching body counts as swinging back after a time without reports") {
  Pushed body{0.2, nothing, 1, 3};
  body.down_m_s = -0.2;
  double off_J = 0;
  for (int ms = 0; ms < 65; ++ms) {
    off_J = body.step(0.5);
    if (ms > 1 && ms < 35) CHECK(std::abs(off_J) < 1e-6);
  }
  // 0.5 N on a body that is faster by 0.4 m/s, for the last 20 ms at least.
  CHECK(off_J > 0.004);
}

TEST_CASE("A push that was never applied does not remain pending") {
  Pushed body{0.2, nothing, 2};
  for (int ms = 0; ms < 100; ++ms) body.step(1);
  body.impulse_N_s -= 0.5;  // from now on the simulation reports less
  for (int ms = 0; ms < 100; ++ms) body.step(0);
  CHECK(body.estimator.energy_J(0.002, kMax_N) < 0.02 * 0.02 / (2 * 0.2) + 0.02 * 0.5 + 1e-9);
}
