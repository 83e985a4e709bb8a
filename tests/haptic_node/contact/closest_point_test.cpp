#include "haptic_node/contact/closest_point.h"

#include <catch2/catch.hpp>
#include <random>

using namespace tactus::haptic;
using Eigen::Vector3d;

namespace {

Vector3d random_unit(std::mt19937& random) {
  std::normal_distribution<double> normal;
  return Vector3d(normal(random), normal(random), normal(random)).normalized();
}

// Random half spaces that all contain a given point, as around a tool between surfaces.
std::vector<HalfSpace> random_region(std::mt19937& random, int count, const Vector3d& inside) {
  std::uniform_real_distribution<double> clearance(0, 0.02);
  std::vector<HalfSpace> region;
  for (int i = 0; i < count; ++i) {
    const Vector3d n = random_unit(random);
    region.push_back({n, n.dot(inside) - clearance(random)});
  }
  return region;
}

// Oracle: Dykstra's alternating projections (1983), which converge to the closest point of any convex region.
Vector3d dykstra(const std::vector<HalfSpace>& region, const Vector3d& goal) {
  std::vector<Vector3d> correction(region.size(), Vector3d::Zero());
  Vector3d x = goal;
  for (int sweep = 0; sweep < 20000; ++sweep) {
    for (std::size_t i = 0; i < region.size(); ++i) {
      const Vector3d y = x + correction[i];
      x = y + std::max(0.0, region[i].offset - region[i].normal.dot(y)) * region[i].normal;
      correction[i] = y - x;
    }
  }
  return x;
}

}  // namespace

TEST_CASE("The closest point satisfies the Karush-Kuhn-Tucker conditions of up to 64 random half spaces") {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> place(-0.03, 0.03);
  for (int round = 0; round < 5000; ++round) {
    const Vector3d inside(place(random), place(random), place(random));
    const auto region = random_region(random, 1 + round % 64, inside);
    const Vector3d goal(place(random), place(random), place(random));
    const ClosestPoint c = closest_point(region, goal);
    REQUIRE(c.feasible);
    Vector3d sum = goal;
    for (std::size_t i = 0; i < region.size(); ++i) {
      const double height = region[i].normal.dot(c.point) - region[i].offset;
      REQUIRE(height > -2e-9);                                                       // allowed
      REQUIRE(c.multiplier[i] >= 0);                                                 // never pulls
      REQUIRE(std::abs(c.multiplier[i] * height) < 1e-12 + 1e-8 * c.multiplier[i]);  // pushes only where it binds
      sum += c.multiplier[i] * region[i].normal;
    }
    REQUIRE((sum - c.point).norm() < 1e-9);
  }
}

TEST_CASE("The closest point equals the result of alternating projections") {
  std::mt19937 random(12);
  std::uniform_real_distribution<double> place(-0.03, 0.03);
  for (int round = 0; round < 60; ++round) {
    const Vector3d inside(place(random), place(random), place(random));
    const auto region = random_region(random, 1 + round % 50, inside);
    const Vector3d goal(place(random), place(random), place(random));
    const Vector3d found = closest_point(region, goal).point, oracle = dykstra(region, goal);
    // Dykstra converges slowly in narrow wedges: it may stop before the goal, never beyond it.
    CHECK((found - oracle).norm() < 2e-5);
    CHECK((found - goal).norm() < (oracle - goal).norm() + 2e-5);
  }
}

TEST_CASE("The closest point moves no farther than its goal") {
  // Projection onto a convex set is non-expansive.
  std::mt19937 random(13);
  std::uniform_real_distribution<double> place(-0.03, 0.03), small(-1e-3, 1e-3);
  for (int round = 0; round < 2000; ++round) {
    const auto region = random_region(random, 50, Vector3d::Zero());
    const Vector3d a(place(random), place(random), place(random));
    const Vector3d b = a + Vector3d(small(random), small(random), small(random));
    REQUIRE((closest_point(region, a).point - closest_point(region, b).point).norm() < (a - b).norm() + 1e-8);
  }
}

TEST_CASE("Equal, parallel and nearly parallel half spaces are solved") {
  const std::vector<HalfSpace> region{{Vector3d::UnitZ(), 0},
                                      {Vector3d::UnitZ(), 0},
                                      {Vector3d::UnitZ(), -0.001},
                                      {Vector3d(1e-7, 0, 1).normalized(), 0},
                                      {Vector3d(0, 1e-3, 1).normalized(), 0}};
  const ClosestPoint c = closest_point(region, {0, 0, -0.002});
  CHECK(c.feasible);
  CHECK((c.point - Vector3d::Zero()).norm() < 1e-5);
  double total = 0;
  for (const double m : c.multiplier) total += m;
  CHECK(total == Approx(0.002).epsilon(1e-3));
}

TEST_CASE("Between walls without room the point is in the middle, and each wall has its own depth") {
  const std::vector<HalfSpace> region{{Vector3d::UnitX(), 0.001}, {-Vector3d::UnitX(), 0.001}};
  const ClosestPoint c = closest_point(region, {0.0002, 0.5, 0});
  CHECK_FALSE(c.feasible);
  CHECK(std::abs(c.point.x()) < 1e-4);
  CHECK(c.point.y() == Approx(0.5));
  CHECK(c.multiplier[0] == Approx(0.0008));
  CHECK(c.multiplier[1] == Approx(0.0012));
}

TEST_CASE("The facets around a point of a fine mesh, nearly parallel and nearly through one point, are solved") {
  std::mt19937 random(14);
  std::uniform_real_distribution<double> place(-1, 1);
  for (int round = 0; round < 3000; ++round) {
    // Facets that touch a sphere or a cup of 0.1 m within a few millimetres, down to the width of a hair.
    const double spread = std::pow(10.0, -1.0 - 0.5 * (round % 9)), cup = round % 2 == 0 ? 1 : -1;
    const Vector3d far = 10 * Vector3d(place(random), place(random), place(random));
    std::vector<HalfSpace> region;
    for (int i = 0; i < 50; ++i) {
      const Vector3d n = Vector3d(spread * place(random), spread * place(random), 1).normalized();
      region.push_back({n, n.dot(far + 0.1 * Vector3d::UnitZ() - cup * 0.1 * (Vector3d::UnitZ() - n))});
    }
    const Vector3d goal = far + Vector3d(0.001 * place(random), 0.001 * place(random), 0.097);
    const ClosestPoint c = closest_point(region, goal);
    CAPTURE(round, spread, cup);
    REQUIRE(c.feasible);
    Vector3d sum = goal;
    for (std::size_t i = 0; i < region.size(); ++i) {
      REQUIRE(region[i].normal.dot(c.point) - region[i].offset > -1e-6);
      REQUIRE(c.multiplier[i] >= 0);
      sum += c.multiplier[i] * region[i].normal;
    }
    REQUIRE((sum - c.point).norm() < 1e-9);
  }
}

TEST_CASE("No small motion of the point improves the compromise between fifty walls without room") {
  std::mt19937 random(15);
  std::uniform_real_distribution<double> pinch(0, 0.003);
  for (int round = 0; round < 300; ++round) {
    std::vector<HalfSpace> region;
    for (int i = 0; i < 50; ++i) region.push_back({random_unit(random), pinch(random)});
    const Vector3d goal = 0.002 * random_unit(random);
    const ClosestPoint c = closest_point(region, goal);
    REQUIRE_FALSE(c.feasible);
    // The squares of the violations, plus a fiftieth of the square of the distance from the goal, which decides
    // between equal costs.
    const auto cost = [&](const Vector3d& x) {
      double sum = 0.02 * (x - goal).squaredNorm();
      for (const HalfSpace& h : region) {
        const double by = std::max(0.0, h.offset - h.normal.dot(x));
        sum += by * by;
      }
      return sum;
    };
    const double least = cost(c.point);
    for (int k = 0; k < 20; ++k) REQUIRE(cost(c.point + 1e-6 * random_unit(random)) > least);
    for (std::size_t i = 0; i < region.size(); ++i)
      REQUIRE(c.multiplier[i] == Approx(std::max(0.0, region[i].offset - region[i].normal.dot(goal))).margin(1e-15));
  }
}
