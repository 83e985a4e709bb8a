#include "sim_node/model/manifold.h"

#include <algorithm>
#include <catch2/catch.hpp>

#include "sim_node/collision/gaps/select_points.h"
#include <random>
#include <vector>

using namespace tactus::sim;

TEST_CASE("The reduction keeps the deepest point and the corners of a patch") {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> u(0, 1);
  for (int round = 0; round < 50; ++round) {
    std::vector<ManifoldPoint> found;
    for (const double x : {0.0, 1.0})
      for (const double y : {0.0, 1.0}) found.push_back({{x, y, 0}, {0, 0, 1}, 1e-4 * u(random)});
    for (int i = 0; i < 30; ++i) found.push_back({{0.2 + 0.6 * u(random), 0.2 + 0.6 * u(random), 0}, {0, 0, 1}, 1e-4 * u(random)});
    std::shuffle(found.begin(), found.end(), random);
    Manifold m;
    reduce_points(found, m);
    REQUIRE(m.count == 4);
    double deepest = 0;
    for (const ManifoldPoint& p : found) deepest = std::max(deepest, p.depth_m);
    CHECK(m.points[0].depth_m == deepest);
    // At least three of the four are corners; the fourth is the deepest.
    int corners = 0;
    for (const ManifoldPoint& p : m.used()) corners += (p.point_m.x() == 0 || p.point_m.x() == 1);
    CHECK(corners >= 3);
  }
}

TEST_CASE("The reduction merges duplicates but keeps two normals at one position") {
  Manifold m;
  reduce_points(std::vector<ManifoldPoint>(20, ManifoldPoint{{1, 2, 3}, {0, 0, 1}, 1e-3}), m);
  CHECK(m.count == 1);
  reduce_points(std::vector<ManifoldPoint>{{{1, 2, 3}, {0, 0, 1}, 1e-3}, {{1, 2, 3}, {0, 1, 0}, 1e-3}}, m);
  CHECK(m.count == 2);
  reduce_points({}, m);
  CHECK(m.count == 0);
}

TEST_CASE("The reduction of points with gaps keeps the near ones of every face") {
  const auto point = [](double x, double y, double gap, const Eigen::Vector3d& n) {
    ManifoldPoint p;
    p.point_m = {x, y, 0};
    p.depth_m = -gap;
    p.normal = n;
    return p;
  };
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ(), aside = Eigen::Vector3d::UnitX();
  Manifold m;
  // The four lower corners of a tilted box, and distant ones high above.
  std::vector<ManifoldPoint> found{point(0, 0, 0, up),        point(0.1, 0, 1e-3, up),   point(0, 0.1, 1e-3, up),
                                   point(0.1, 0.1, 2e-3, up), point(0.2, 0, 0.08, up),   point(0.2, 0.2, 0.09, up),
                                   point(0, 0.2, 0.1, up),    point(-0.2, -0.2, 0.2, up)};
  gaps::select_points(found, m);
  REQUIRE(m.count == 4);
  for (const ManifoldPoint& p : m.used()) CHECK(-p.depth_m < 0.01);
  // Its corners on a floor, two of them also at a wall. Each face keeps its own points: with three on the floor a body
  // would tip about their edges, and with one at the wall it would turn about it.
  found = {point(0, 0, 0, up),   point(0.1, 0, 0, up),       point(0, 0.1, 0, up),
           point(0.1, 0.1, 0, up), point(0.1, 0, 1e-5, aside), point(0.1, 0.1, 1e-5, aside)};
  gaps::select_points(found, m);
  REQUIRE(m.count == 6);
  CHECK(std::count_if(m.used().begin(), m.used().end(), [&](const ManifoldPoint& p) { return p.normal == up; }) == 4);
  CHECK(std::count_if(m.used().begin(), m.used().end(), [&](const ManifoldPoint& p) { return p.normal == aside; }) == 2);
  gaps::select_points({}, m);
  CHECK(m.count == 0);
}
