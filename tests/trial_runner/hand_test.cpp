// Tests of the taps and presses of the trial runner's hand.
#include "scripts/trial_runner/hand.h"

#include <catch2/catch.hpp>

using namespace tactus::trial_runner;
using Eigen::Vector3d;

namespace {

constexpr double kStep_s = 1e-3;

struct Path {
  double lowest_m = 1e9, fastest_m_s = 0, largest_step_m = 0, seconds = 0;
};

Path followed(Hand& hand) {
  Path path;
  Vector3d before = hand.position_m();
  while (hand.busy() && path.seconds < 60) {
    hand.step(kStep_s);
    path.seconds += kStep_s;
    path.lowest_m = std::min(path.lowest_m, hand.position_m().z());
    path.fastest_m_s = std::max(path.fastest_m_s, hand.velocity_m_s().norm());
    path.largest_step_m = std::max(path.largest_step_m, (hand.position_m() - before).norm());
    before = hand.position_m();
  }
  return path;
}

}  // namespace

TEST_CASE("A tap reaches its depth below the surface and comes back to rest") {
  Hand hand({0.1, 0.2, 0.04}, 0.032);
  REQUIRE(hand.tap({0.012}));
  const Path path = followed(hand);
  CHECK(path.lowest_m == Approx(0.04 - 0.044));
  CHECK((hand.position_m() - Vector3d(0.1, 0.2, 0.04)).norm() < 1e-12);
  CHECK(path.seconds < 0.3);
  hand.step(kStep_s);
  CHECK(hand.velocity_m_s().norm() == 0);
}

TEST_CASE("The hand moves without position jumps") {
  Hand hand({0, 0, 0.04}, 0.032);
  SECTION("of a tap") { REQUIRE(hand.tap({0.05})); }
  SECTION("of a press") { REQUIRE(hand.press({0.02, 0.5, 3})); }
  const Path path = followed(hand);
  CHECK(path.fastest_m_s < 1.3);  // for half a cosine the peak speed is pi / 2 times the mean
  CHECK(path.largest_step_m < 1.3 * kStep_s);
}

TEST_CASE("A press reaches its depth the given number of times, in the given periods") {
  Hand hand({0, 0, 0.04}, 0.032);
  REQUIRE(hand.press({0.01, 0.5, 4}));
  int presses = 0;
  bool deep = false;
  double seconds = 0;
  for (; hand.busy(); seconds += kStep_s) {
    hand.step(kStep_s);
    const bool now_deep = hand.position_m().z() < 0.008 - 0.0099;
    presses += now_deep && !deep;
    deep = now_deep;
  }
  CHECK(presses == 4);
  CHECK(seconds == Approx(4 * 0.5 + 1).margin(0.01));
}

TEST_CASE("A moving hand rejects a second request") {
  Hand hand({0, 0, 0.04}, 0.032);
  REQUIRE(hand.tap({0.01}));
  CHECK_FALSE(hand.tap({0.01}));
  CHECK_FALSE(hand.press({0.01, 1, 1}));
}
