#include <catch2/catch.hpp>

#include "sim_node/collision/gaps/mesh_pair.h"
#include "sim_node/collision/gaps/select_points.h"

using namespace tactus::sim;
using Eigen::Vector3d;

namespace {

Triangle triangle_of(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  Triangle t;
  t.v[0] = a, t.v[1] = b, t.v[2] = c;
  t.normal = (b - a).cross(c - a).normalized();
  return t;
}

}  // namespace

TEST_CASE("A contact with floor and two walls has four points for each") {
  std::vector<ManifoldPoint> found;
  for (const Vector3d& n : {Vector3d(0, 0, 1), Vector3d(1, 0, 0), Vector3d(0, 1, 0)})
    for (int i = 0; i < 9; ++i) {
      ManifoldPoint p;
      const Vector3d u = n.unitOrthogonal();
      p.point_m = 0.1 * (i % 3) * u + 0.1 * (i / 3) * n.cross(u);
      p.normal = n;
      p.depth_m = -1e-6 * n.x();
      found.push_back(p);
    }
  Manifold m;
  gaps::select_points(found, m);
  REQUIRE(m.count == 12);
  for (int face = 0; face < 3; ++face)
    for (int i = 1; i < 4; ++i)
      CHECK(m.points[static_cast<std::size_t>(4 * face + i)].normal == m.points[static_cast<std::size_t>(4 * face)].normal);
}

TEST_CASE("Two edges that barely cross are separated across the edges") {
  // Two roofs whose ridges cross at a right angle and overlap by 1 um.
  const Triangle a = triangle_of({-1, 0, 0}, {1, 0, 0}, {0, 1, -1});
  const Triangle b = triangle_of({0, -1, -1e-6}, {0, 1, -1e-6}, {1, 0, 1});
  PointPair p;
  p.on_a_m = p.on_b_m = Vector3d::Zero();
  p.pierced = true;
  gaps::resolve_piercing(a, b, p);
  CHECK(p.gap_m == Approx(-1e-6).epsilon(1e-3));
  CHECK(std::abs(p.normal.z()) == Approx(1).epsilon(1e-9));
}

TEST_CASE("Two sides that cross just below a top are separated upwards, along the edge of the top") {
  // A block 1 m high, and a wider box that is 0.1 mm below its top.
  const Triangle wide = triangle_of({-0.1, -0.1, -1e-4}, {0.1, -0.1, -1e-4}, {0.1, -0.1, 0.1});
  REQUIRE(wide.normal.y() == Approx(-1));
  const Triangle top = triangle_of({-0.05, -0.5, 0}, {-0.05, 0.5, 0}, {-0.05, 0.5, -1});
  PointPair p;
  p.on_a_m = p.on_b_m = Vector3d(-0.05, -0.1, 0);
  p.pierced = true;
  gaps::resolve_piercing(top, wide, p);
  CHECK(p.gap_m == Approx(-1e-4).epsilon(1e-3));
  CHECK(p.normal.z() == Approx(1).epsilon(1e-9));
}

TEST_CASE("A corner slightly behind a face that faces it overlaps, and a corner beside a touching face is no contact") {
  const Triangle top = triangle_of({-1, -1, 0}, {1, -1, 0}, {0, 1, 0}), bottom = triangle_of({-0.1, -0.1, -1e-5}, {0, 0.1, -1e-5}, {0.1, -0.1, -1e-5});
  REQUIRE(top.normal.z() == Approx(1));
  REQUIRE(bottom.normal.z() == Approx(-1));
  PointPair p;
  p.on_a_m = {0, 0, 0}, p.on_b_m = {0, 0, -1e-5};
  p.normal = {0, 0, -1};
  p.gap_m = 1e-5;
  CHECK(gaps::orient(top, bottom, false, p));
  CHECK(p.gap_m == -1e-5);
  CHECK(p.normal.z() == 1);
  const Triangle side = triangle_of({0, -0.1, 0}, {0, 0.1, 0}, {0, 0.1, -0.2}), floor = triangle_of({0.2, -0.1, 0}, {0, -0.1, 0}, {0, 0.1, 0});
  PointPair q;
  q.on_a_m = q.on_b_m = {0, 0, 0};
  q.normal = {std::copysign(1.0, side.normal.x()), 0, 0};
  q.gap_m = 0;
  CHECK_FALSE(gaps::orient(side, floor, false, q));
}
