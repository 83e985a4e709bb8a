#include "audio_node/spatial/hull.h"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <set>

#include "tests/audio_node/support/kemar.h"

using namespace tactus::audio;
using Eigen::Vector3d;

namespace {

// Every edge belongs to two triangles with opposite directions, and no point lies outside of any triangle.
void check_closed(const std::vector<Vector3d>& points, const std::vector<Triangle>& hull) {
  std::set<std::pair<int, int>> edges;
  const auto at = [&](int i) { return points[static_cast<std::size_t>(i)]; };
  int outside = 0;
  for (const Triangle& t : hull) {
    for (std::size_t i = 0; i < 3; ++i) CHECK(edges.insert({t[i], t[(i + 1) % 3]}).second);
    const Vector3d normal = (at(t[1]) - at(t[0])).cross(at(t[2]) - at(t[0]));
    // Points are nudged by 1e-6 to divide planes into triangles.
    for (const Vector3d& p : points) outside += normal.dot(p - at(t[0])) > 4e-6;
  }
  CHECK(outside == 0);
  for (const auto& [a, b] : edges) CHECK(edges.contains({b, a}));
  // Euler: a closed surface of triangles on n corners.
  CHECK(hull.size() == 2 * points.size() - 4);
}

}  // namespace

TEST_CASE("The hull of the corners of a cube divides its faces into triangles") {
  std::vector<Vector3d> corners;
  for (int i = 0; i < 8; ++i)
    corners.push_back(Vector3d(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1).normalized());
  check_closed(corners, convex_hull(corners));
}

TEST_CASE("The hull of all measured directions is closed") {
  check_closed(test::kemar().directions, convex_hull(test::kemar().directions));
}

TEST_CASE("Directions in one plane have no hull") {
  std::vector<Vector3d> ring;
  for (int i = 0; i < 12; ++i)
    ring.emplace_back(std::cos(i * std::numbers::pi / 6), std::sin(i * std::numbers::pi / 6), 0);
  CHECK(convex_hull(ring).empty());
  CHECK(convex_hull({Vector3d::UnitX(), Vector3d::UnitY(), Vector3d::UnitZ()}).empty());
}

TEST_CASE("The solid angles of directions cover the whole sphere") {
  const double pi = std::numbers::pi;
  std::vector<Vector3d> axes;
  for (int i = 0; i < 3; ++i)
    for (const double sign : {-1.0, 1.0}) axes.push_back(sign * Vector3d::Unit(i));
  for (const double part : solid_angles(axes)) CHECK(part == Approx(4 * pi / 6));
  SECTION("duplicate directions share their part") {
    axes.push_back(axes[3]);
    const auto parts = solid_angles(axes);
    for (const std::size_t i : {0, 1, 2, 4, 5}) CHECK(parts[i] == Approx(4 * pi / 6).epsilon(1e-5));
    CHECK(parts[3] + parts[6] == Approx(4 * pi / 6).epsilon(1e-5));
  }
  SECTION("the measured directions cover the sphere") {
    const auto directions = test::kemar().directions;
    double sum = 0;
    for (const double part : solid_angles(directions)) sum += part;
    CHECK(sum == Approx(4 * pi).epsilon(1e-6));
  }
}
