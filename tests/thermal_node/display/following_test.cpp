#include "thermal_node/display/following.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <random>

using namespace tactus::thermal;
using Result = Following::Result;

namespace {
constexpr double kTick_s = 0.02, kNeutral_degC = 33;
}  // namespace

TEST_CASE("A plate at any speed of 1 K/s or more follows any command") {
  std::mt19937 random(4);
  const auto uniform = [&](double low, double high) { return std::uniform_real_distribution(low, high)(random); };
  for (int trial = 0; trial < 200; ++trial) {
    Following following;
    const double speed_K_s = trial % 4 ? uniform(1, 30) : 1;
    double plate = uniform(10, 43), command = 33;
    for (int i = 0; i < 2000; ++i) {
      if (random() % 50 == 0) command = uniform(10, 43);
      plate += std::clamp(command - plate, -speed_K_s * kTick_s, speed_K_s * kTick_s);
      // A sensor that is wrong by a kelvin.
      REQUIRE(following.step(command, plate + 1, false, kNeutral_degC, kTick_s) == Result::kFollows);
    }
  }
}

TEST_CASE(
    "A reading that does not move while the command does is a failure within seconds, until another display "
    "begins") {
  Following following;
  int ticks = 0;
  while (following.step(42, 33, false, kNeutral_degC, kTick_s) == Result::kFollows && ticks < 10'000) ++ticks;
  // 2 K at 1 K/s, and the patience of half a second.
  CHECK(ticks * kTick_s == Approx(2.5).margin(0.1));
  for (int i = 0; i < 5000; ++i) REQUIRE(following.step(33, 33, false, kNeutral_degC, kTick_s) == Result::kFailed);
  following.restart();
  CHECK(following.step(33, 33, false, kNeutral_degC, kTick_s) == Result::kFollows);
}

TEST_CASE("A plate that is further from neutral than its command has failed, also if it reports its limit") {
  for (const double plate : {42.0, 15.0}) {
    Following following;
    Result result = Result::kFollows;
    // 7 to 16 K on the way back at 1 K/s.
    for (int i = 0; i < 50 * 20; ++i)
      result = following.step(plate > 33 ? 35 : 31, plate, true, kNeutral_degC, kTick_s);
    CHECK(result == Result::kFailed);
  }
}

TEST_CASE("A display that reports its limit falls short, and follows again some seconds after it does") {
  Following following;
  Result result = Result::kFollows;
  for (int i = 0; i < 50 * 5; ++i) result = following.step(42, 36, true, kNeutral_degC, kTick_s);
  CHECK(result == Result::kShort);
  int ticks = 0;
  while (following.step(37, 36, true, kNeutral_degC, kTick_s) == Result::kShort && ticks < 10'000) ++ticks;
  CHECK(ticks * kTick_s == Approx(Following::kShort_s).margin(0.1));
}

TEST_CASE("After a time that was not observed the plate may be anywhere between its reading and its command") {
  Following following;
  for (int i = 0; i < 100; ++i) following.step(42, 42, false, kNeutral_degC, kTick_s);
  following.skip();
  CHECK(following.step(33, 15, false, kNeutral_degC, kTick_s) == Result::kFollows);
  for (int i = 0; i < 25; ++i) CHECK(following.step(33, 15, false, kNeutral_degC, kTick_s) == Result::kFollows);
}
