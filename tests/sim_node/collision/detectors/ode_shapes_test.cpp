#include "sim_node/collision/detectors/ode_shapes.h"

#include <catch2/catch.hpp>
#include <set>

#include "sim_node/behaviour/solver.h"
#include "sim_node/collision/closest_surface.h"
#include "sim_node/model/triangles.h"
#include "tests/sim_node/support/small_worlds.h"

using namespace tactus::sim;
using namespace tactus::sim::test;
using Eigen::Vector3d;

namespace {

// A field without mirror symmetry: a plane that rises along x and half as steeply along y.
Heightfield slope() {
  Heightfield f;
  f.columns = 11;
  f.rows = 7;
  f.size_m = {2, 1, 0.5};
  f.centre_m = {0.1, -0.2, 0.3};
  for (int row = 0; row < f.rows; ++row)
    for (int column = 0; column < f.columns; ++column)
      f.heights_m.push_back(0.05 * column / 10.0 + 0.025 * row / 6.0);
  return f;
}

// Height at a point of the shape frame.
double height(double x, double y) { return 0.3 + 0.05 * (x - 0.1 + 1) / 2 + 0.025 * (y + 0.2 + 0.5); }

TriangleMesh tetrahedron(double edge) {
  TriangleMesh m;
  const double s = edge / std::sqrt(8.0);
  m.vertices = {{s, s, s}, {s, -s, -s}, {-s, s, -s}, {-s, -s, s}};
  m.indices = {0, 1, 2, 0, 2, 3, 0, 3, 1, 1, 3, 2};
  m.normals.assign(4, Vector3d::UnitZ());
  return m;
}

}  // namespace

TEST_CASE("A height field has its nominal height for bodies and tools") {
  WorldDef w = empty_world(0);
  const int ground = add_body(w, "ground", 0, Eigen::Matrix3d::Identity(), at(0.3, 0.4, -0.1));
  const int shape = add_shape(w, ground, ShapeKind::kHeightfield, {1, 1, 1});
  w.shapes[static_cast<std::size_t>(shape)].mesh = 0;
  w.heightfields.push_back(slope());
  const TriangleMesh mesh = triangulate(w.heightfields[0], 1025);
  const ClosestSurface surface(w.shapes[static_cast<std::size_t>(shape)],
                               std::make_shared<const TriangleTree>(mesh.vertices, mesh.indices));
  std::vector<SurfacePlane> planes;
  const double r = 0.03;
  for (const double x : {-0.7, -0.13, 0.4, 0.95})
    for (const double y : {-0.55, -0.2, 0.17}) {
      INFO(x << " " << y);
      const double depth = 0.002;
      // The slope is gentle: the depth of a ball equals the depth of its lowest point, to second order of the slope.
      const double z = height(x, y) + r - depth;
      WorldDef with_ball = w;
      add_ball(with_ball, 1, r, Vector3d(0.3, 0.4, -0.1) + Vector3d(x, y, z));
      const Solver solver(with_ball, {});
      REQUIRE(solver.contacts().size() == 1);
      const ManifoldPoint& p = solver.contacts()[0].points[0];
      CHECK(p.depth_m == Approx(depth).margin(1e-4));
      CHECK((p.normal - Vector3d(-0.025, -0.025, 1).normalized()).norm() < 1e-3);
      surface.query({x, y, height(x, y) + 0.01}, 0.05, planes);
      REQUIRE_FALSE(planes.empty());
      CHECK(planes[0].distance_m == Approx(0.01).margin(1e-4));
      CHECK((planes[0].normal - Vector3d(-0.025, -0.025, 1).normalized()).norm() < 1e-3);
    }
}

TEST_CASE("Every pair of shapes collides with a unit normal from the first body to the second") {
  std::vector<ShapeKind> kinds{ShapeKind::kBox, ShapeKind::kSphere, ShapeKind::kCylinder, ShapeKind::kCapsule, ShapeKind::kMesh};
  for (const ShapeKind lower : {ShapeKind::kBox, ShapeKind::kSphere, ShapeKind::kCylinder, ShapeKind::kCapsule, ShapeKind::kMesh,
                                ShapeKind::kPlane, ShapeKind::kHeightfield})
    for (const ShapeKind upper : kinds)
      for (const bool swapped : {false, true}) {
        WorldDef w = empty_world(0);
        w.meshes.push_back(tetrahedron(0.2));
        Heightfield flat = slope();
        flat.centre_m.setZero();
        flat.heights_m.assign(flat.heights_m.size(), 0);
        w.heightfields.push_back(flat);
        const auto half = [](ShapeKind k) {
          return k == ShapeKind::kPlane || k == ShapeKind::kHeightfield ? 0 : k == ShapeKind::kCapsule ? 0.1
                 : k == ShapeKind::kMesh                              ? 0.2 / std::sqrt(8.0)
                                                                      : 0.05;
        };
        const auto add = [&](ShapeKind k, double z, bool fixed) {
          const int body = add_body(w, "b", fixed ? 0 : 1, Eigen::Matrix3d::Identity() * 1e-3, at(0.002, 0.003, z));
          const Vector3d size = k == ShapeKind::kBox ? Vector3d(0.1, 0.1, 0.1) : Vector3d(0.05, 0, 0.1);
          const int s = add_shape(w, body, k, size);
          w.shapes[static_cast<std::size_t>(s)].mesh = 0;
          return body;
        };
        const bool fixed = half(lower) == 0;
        const double z = half(lower) + half(upper) - 0.004;
        const int below = swapped ? (add(upper, z, false), add(lower, 0, fixed)) : add(lower, 0, fixed);
        if (!swapped) add(upper, z, false);
        const Solver solver(w, {});
        INFO("lower " << static_cast<int>(lower) << " upper " << static_cast<int>(upper) << " swapped " << swapped);
        REQUIRE(solver.contacts().size() == 1);
        const Manifold& m = solver.contacts()[0];
        CHECK(m.body_a == 0);
        CHECK(m.body_b == 1);
        for (const ManifoldPoint& p : m.used()) CHECK(p.normal.norm() == Approx(1));
        // The tetrahedra touch with edges or faces of their own. The other shapes face each other.
        if (lower == ShapeKind::kMesh || upper == ShapeKind::kMesh) continue;
        CHECK(m.points[0].normal.z() * (below == 0 ? 1 : -1) > 0.9);
        CHECK(m.points[0].depth_m == Approx(0.004).margin(0.001));
      }
}

TEST_CASE("Excluded pairs, tools and two static bodies do not collide") {
  WorldDef w = empty_world(0);
  add_floor(w);
  const int a = add_ball(w, 1, 0.1, {0, 0, 0.05}), b = add_ball(w, 1, 0.1, {0.05, 0, 0.05});
  const int wall = add_body(w, "wall", 0, Eigen::Matrix3d::Identity(), at(1, 1, 0));
  add_shape(w, wall, ShapeKind::kBox, {1, 1, 1});
  const int tool = add_body(w, "tool", 0, Eigen::Matrix3d::Identity(), at(0, 0, 0.05));
  w.bodies[static_cast<std::size_t>(tool)].tool = 0;
  w.bodies[static_cast<std::size_t>(tool)].is_static = false;
  add_shape(w, tool, ShapeKind::kSphere, {0.1, 0, 0});
  CHECK(Solver(w, {}).contacts().size() == 3);
  w.no_collision.emplace_back(b, a);
  CHECK(Solver(w, {}).contacts().size() == 2);
  w.no_collision.emplace_back(0, a);
  CHECK(Solver(w, {}).contacts().size() == 1);
}

TEST_CASE("A body of several shapes has a separate contact for each pair") {
  WorldDef w = empty_world(0);
  add_floor(w);
  const int body = add_body(w, "feet", 1, Eigen::Matrix3d::Identity(), at(0, 0, 0.019));
  w.bodies[static_cast<std::size_t>(body)].centre_of_mass_m = {0.1, 0.2, 0.3};
  for (const double x : {-0.2, 0.2})
    for (const double y : {-0.1, 0.1}) w.shapes[static_cast<std::size_t>(add_shape(w, body, ShapeKind::kSphere, {0.02, 0, 0}))].pose = at(x, y, 0);
  const Solver solver(w, {});
  REQUIRE(solver.contacts().size() == 4);
  std::set<std::pair<double, double>> places;
  for (const Manifold& m : solver.contacts()) {
    places.insert({std::round(m.points[0].point_m.x() * 1e6) / 1e6, std::round(m.points[0].point_m.y() * 1e6) / 1e6});
    CHECK(m.points[0].depth_m == Approx(0.001));
  }
  CHECK(places == std::set<std::pair<double, double>>{{-0.2, -0.1}, {-0.2, 0.1}, {0.2, -0.1}, {0.2, 0.1}});
}

TEST_CASE("A moving plane has the shape of a plate") {
  WorldDef w = empty_world(0);
  const int plate = add_body(w, "plate", 1, Eigen::Matrix3d::Identity(), at(0, 0, 1));
  add_shape(w, plate, ShapeKind::kPlane, {0.4, 0.4, 1});
  add_ball(w, 1, 0.05, {0, 0, 1.049});
  const Solver solver(w, {});
  REQUIRE(solver.contacts().size() == 1);
  CHECK(solver.contacts()[0].points[0].normal.z() == Approx(1));
  CHECK(solver.contacts()[0].points[0].depth_m == Approx(0.001));
}
