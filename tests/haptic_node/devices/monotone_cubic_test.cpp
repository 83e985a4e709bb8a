#include "haptic_node/devices/monotone_cubic.h"

#include <catch2/catch.hpp>
#include <random>

using namespace tactus::haptic;
using Eigen::Vector3d;

TEST_CASE("A monotone cubic passes its points without overshoot and with continuous velocity") {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(-1, 1), wait(0.05, 0.5);
  std::vector<double> times;
  std::vector<Vector3d> points;
  for (double t = 0; times.size() < 40; t += wait(random)) {
    times.push_back(t);
    points.emplace_back(place(random), place(random), place(random));
  }
  const MonotoneCubic curve(times, points, MonotoneCubic::Ends::kRest);
  for (std::size_t i = 0; i < times.size(); ++i) CHECK((curve.at(times[i]).position - points[i]).norm() < 1e-12);
  constexpr double h = 1e-6;
  for (double t = times.front() + h; t < times.back() - h; t += 0.0037) {
    const auto [i, s] = curve.locate(t);
    const auto at = curve.at(t);
    for (int k = 0; k < 3; ++k) {
      CHECK(at.position[k] >= std::min(points[i][k], points[i + 1][k]) - 1e-12);
      CHECK(at.position[k] <= std::max(points[i][k], points[i + 1][k]) + 1e-12);
    }
    const Vector3d difference = (curve.at(t + h).position - curve.at(t - h).position) / (2 * h);
    CHECK((difference - at.velocity).norm() < 1e-3);  // curvature of at most 1e3 m/s^2 times h
  }
}

TEST_CASE("A monotone cubic through samples of uniform motion is the uniform motion") {
  std::vector<double> times;
  std::vector<Vector3d> points;
  for (int i = 0; i < 20; ++i) {
    times.push_back(0.01 * i);
    points.emplace_back(0.3 * times.back(), 0, 1 - times.back());
  }
  const MonotoneCubic curve(times, points, MonotoneCubic::Ends::kMoving);
  for (double t = 0.0001; t < 0.19; t += 0.0013) {
    CHECK((curve.at(t).position - Vector3d(0.3 * t, 0, 1 - t)).norm() < 1e-12);
    CHECK((curve.at(t).velocity - Vector3d(0.3, 0, -1)).norm() < 1e-9);
  }
}

TEST_CASE("A curve is constant outside its points") {
  const MonotoneCubic curve({1, 2}, {Vector3d::Zero(), Vector3d::UnitX()}, MonotoneCubic::Ends::kMoving);
  CHECK(curve.at(0).position == Vector3d::Zero());
  CHECK(curve.at(0).velocity == Vector3d::Zero());
  CHECK(curve.at(9).position == Vector3d::UnitX());
  CHECK(curve.at(9).velocity == Vector3d::Zero());
}
