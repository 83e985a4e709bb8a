// The drawn hand moves more or less than the real hand, and returns.
#include "visual_node/frame/display_gain.h"

#include <catch2/catch.hpp>

using tactus::visual::DisplayGain;
using Eigen::Vector3d;

TEST_CASE("At a gain of one the hand is drawn at its exact position") {
  DisplayGain gain;
  for (int i = 0; i < 100; ++i) CHECK(gain.step(Vector3d(0.013 * i, 0, 1), 1, 1 / 60.) == Vector3d::Zero());
}

TEST_CASE("The drawn hand moves by the gain times the real motion") {
  const double g = GENERATE(0.25, 0.5, 2.0);
  DisplayGain gain;
  const Vector3d begin(0.1, 0.2, 0.3);
  Vector3d drawn = begin + gain.step(begin, g, 1 / 60.);
  CHECK(drawn == begin);
  const Vector3d moved(0.05, -0.02, 0.01);
  for (int i = 1; i <= 50; ++i) {
    const Vector3d at = begin + i / 50. * moved;
    drawn = at + gain.step(at, g, 1 / 60.);
  }
  CHECK((drawn - begin - g * moved).norm() < 1e-12);
}

TEST_CASE("At a gain of one the offset decays with its time constant") {
  DisplayGain gain;
  gain.step(Vector3d::Zero(), 0.5, 0.01);
  const double off = gain.step(Vector3d(0.1, 0, 0), 0.5, 0.01).norm();
  CHECK(off == Approx(0.05));
  for (int i = 0; i < 100; ++i) CHECK(gain.step(Vector3d(0.1, 0, 0), 0.5, 0.01).norm() == off);
  double left = off;
  for (int i = 0; i < 30; ++i) left = gain.step(Vector3d(0.1, 0, 0), 1, 0.01).norm();
  CHECK(left == Approx(off * std::exp(-1)));
}

TEST_CASE("The offset of the drawn hand is limited to the length of a forearm") {
  DisplayGain gain;
  for (int i = 0; i < 1000; ++i) CHECK(gain.step(Vector3d(0.1 * i, 0, 0), 10, 0.01).norm() <= DisplayGain::kMaxOffset_m * 1.000001);
  gain.reset();
  CHECK(gain.step(Vector3d(5, 0, 0), 10, 0.01) == Vector3d::Zero());
}
