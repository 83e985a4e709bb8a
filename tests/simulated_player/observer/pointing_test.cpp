#include "scripts/simulated_player/observer/pointing.h"

#include <catch2/catch.hpp>
#include <limits>

namespace tactus::observer {
namespace {

double mean_time_s(const PointingDef& def, double width_m, int trials) {
  PointingSession session({}, def, 1);
  double sum = 0;
  for (int i = 0; i < trials; ++i) sum += session.trial(width_m, static_cast<std::uint64_t>(i)).time_s / trials;
  return sum;
}

}  // namespace

TEST_CASE("The width of a target follows the Shannon form of Fitts's index") {
  CHECK(target_width_m(0.2, 1) == Approx(0.2));
  CHECK(target_width_m(0.15, 4) == Approx(0.01));
}

TEST_CASE("A pointing session is the same each time") {
  PointingSession a({}, {.delay_s = 0.1}, 3), b({}, {.delay_s = 0.1}, 3);
  for (std::uint64_t i : {0, 5}) {
    CHECK(a.trial(0.02, i).time_s == b.trial(0.02, i).time_s);
    CHECK(a.trial(0.02, i).hit == b.trial(0.02, i).hit);
  }
}

TEST_CASE("A delay of zero is the undelayed picture, and each added delay costs time") {
  const double none = mean_time_s({}, 0.02, 40), zero = mean_time_s({.delay_s = 0}, 0.02, 40);
  CHECK(none == zero);
  const double some = mean_time_s({.delay_s = 0.1}, 0.02, 40), more = mean_time_s({.delay_s = 0.2}, 0.02, 40);
  CHECK(some > none);
  CHECK(more > some);
}

TEST_CASE("A picture that never comes equals closed eyes, trial by trial") {
  PointingSession never({}, {.delay_s = std::numeric_limits<double>::infinity()}, 1),
      closed({}, {.vision = false}, 1);
  for (std::uint64_t i = 0; i < 20; ++i) {
    const PointingTrial a = never.trial(0.03, i), b = closed.trial(0.03, i);
    CHECK(a.time_s == b.time_s);
    CHECK(a.hit == b.hit);
  }
}

TEST_CASE(
    "A player above the threshold of believed delay moves and waits, so that each movement costs the delay") {
  PlayerParameters player;
  player.wait_threshold_s = 0.3;
  player.motor_adaptation = 0.9;
  const auto time_s = [&](double delay) {
    PointingSession session(player, {.delay_s = delay, .limit_s = 30}, 1);
    double sum = 0;
    for (std::uint64_t i = 0; i < 30; ++i) {
      const PointingTrial t = session.trial(0.03, i);
      CHECK(t.selected);
      sum += t.time_s / 30;
    }
    return sum;
  };
  // At least one wait in each trial.
  CHECK(time_s(1.0) - time_s(0.6) > 0.35);
}

}  // namespace tactus::observer
