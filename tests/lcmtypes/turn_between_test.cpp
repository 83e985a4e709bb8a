#include "lcmtypes/turn_between.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

using namespace tactus;

TEST_CASE("The turn between two directions maps one to the other by the shortest way") {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  const auto draw = [&] { return Eigen::Vector3d(normal(random), normal(random), normal(random)); };
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Vector3d from = draw();
    const Eigen::Vector3d to = draw();
    const Eigen::Quaterniond turn = turn_between(from, to);
    CHECK(std::abs(turn.norm() - 1) < 1e-12);
    CHECK((turn * from.normalized() - to.normalized()).norm() < 1e-7);
    const double angle = std::acos(std::clamp(from.normalized().dot(to.normalized()), -1.0, 1.0));
    CHECK(std::abs(2 * std::acos(std::min(1.0, std::abs(turn.w()))) - angle) < 1e-6);
  }
}

TEST_CASE("The turn between equal directions is none, and between opposite ones half a turn") {
  const Eigen::Vector3d way(1, 2, -3);
  CHECK(turn_between(way, 5 * way).isApprox(Eigen::Quaterniond::Identity()));
  const Eigen::Quaterniond half = turn_between(way, -2 * way);
  CHECK(std::abs(half.w()) < 1e-7);
  CHECK((half * way + way).norm() < 1e-6);
}
