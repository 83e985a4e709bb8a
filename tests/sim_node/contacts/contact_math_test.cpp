#include "sim_node/contacts/contact_math.h"

#include <catch2/catch.hpp>

#include "tests/sim_node/support/small_worlds.h"

using namespace tactus::sim;
using namespace tactus::sim::test;
using Eigen::Vector3d;

namespace {

Manifold through(std::initializer_list<Vector3d> points) {
  Manifold m;
  for (const Vector3d& p : points) m.points[static_cast<std::size_t>(m.count++)].point_m = p;
  return m;
}

}  // namespace

TEST_CASE("The points of a contact determine its kind: point, edge or surface") {
  CHECK(kind_of(through({{0, 0, 0}})) == ContactKind::kPoint);
  CHECK(kind_of(through({{0, 0, 0}, {1, 0, 0}})) == ContactKind::kEdge);
  CHECK(kind_of(through({{0, 0, 0}, {1, 0, 0}, {0.5, 1e-4, 0}})) == ContactKind::kEdge);
  CHECK(kind_of(through({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}})) == ContactKind::kSurface);
}

TEST_CASE("The area of a patch is that of its convex hull for any order of points") {
  std::array<Vector3d, 4> corners{Vector3d(0, 0, 0), Vector3d(2, 0, 0), Vector3d(2, 3, 0), Vector3d(0, 3, 0)};
  std::sort(corners.begin(), corners.end(), [](const Vector3d& a, const Vector3d& b) { return a.sum() < b.sum(); });
  std::array<int, 4> order{0, 1, 2, 3};
  do {
    const Manifold m = through({corners[static_cast<std::size_t>(order[0])], corners[static_cast<std::size_t>(order[1])],
                                corners[static_cast<std::size_t>(order[2])], corners[static_cast<std::size_t>(order[3])]});
    CHECK(contact_area(m, ContactKind::kSurface, 1, 0, 1e-9) == Approx(6));
  } while (std::next_permutation(order.begin(), order.end()));
  CHECK(contact_area(through({{0, 0, 0}, {2, 0, 0}, {0, 3, 0}}), ContactKind::kSurface, 1, 0, 1e-9) == Approx(3));
}

TEST_CASE("Hertzian area grows with force to the power 2/3 at a point and 1/2 along a line") {
  const double one = hertz_point_area(1, 50, 5e-9);
  CHECK(hertz_point_area(8, 50, 5e-9) == Approx(4 * one));
  // Johnson 1985: a = (3 F R / 4 E*)^(1/3).
  CHECK(one == Approx(std::numbers::pi * std::pow(0.75 * 1 * 0.02 * 5e-9, 2.0 / 3)));
  CHECK(hertz_line_area(4, 50, 5e-9, 0.1) == Approx(2 * hertz_line_area(1, 50, 5e-9, 0.1)));
  // A cylinder of radius R on a flat: mean curvature 1 / 2R; half width (4 F R / pi E* L)^(1/2).
  CHECK(hertz_line_area(1, 0.5 / 0.03, 5e-9, 0.1) ==
        Approx(2 * 0.1 * std::sqrt(4 * 0.03 * 5e-9 / (std::numbers::pi * 0.1))));
  CHECK(hertz_point_area(0, 50, 5e-9) == 0);
  CHECK(hertz_point_area(1, 0, 5e-9) == 0);
  // At any compliance, no wider than the ball.
  CHECK(hertz_point_area(1e6, 50, 1) == Approx(std::numbers::pi * 0.02 * 0.02));
}

TEST_CASE("The effective mass matches the closed form") {
  BodyMotion wall, ball, rod;
  ball.inverse_mass_1_kg = 1 / 0.5;
  ball.inverse_inertia = Eigen::Matrix3d::Identity() * 1e3;
  // Central impact: rotation has no effect.
  CHECK(effective_mass(wall, ball, {0, 0, -0.1}, Vector3d::UnitZ()) == Approx(0.5));
  CHECK(effective_mass(ball, ball, {0, 0, 0.1}, Vector3d::UnitZ()) == Approx(0.25));
  // A uniform rod struck at its end: a quarter of its mass.
  const double mass = 0.8, length = 0.6;
  rod.inverse_mass_1_kg = 1 / mass;
  rod.inverse_inertia = Eigen::Matrix3d::Identity() * (12 / (mass * length * length));
  CHECK(effective_mass(wall, rod, {length / 2, 0, 0}, Vector3d::UnitZ()) == Approx(mass / 4));
  CHECK(effective_mass(wall, wall, {0, 0, 0}, Vector3d::UnitZ()) == 1e9);
}

TEST_CASE("Curvature follows from the shape and the contact position") {
  WorldDef w = empty_world();
  const int body = add_body(w, "b", 1, Eigen::Matrix3d::Identity(), at(0, 0, 0));
  add_shape(w, body, ShapeKind::kSphere, {0.05, 0, 0});
  add_shape(w, body, ShapeKind::kBox, {0.2, 0.2, 0.2});
  add_shape(w, body, ShapeKind::kCylinder, {0.1, 0, 0.4});
  add_shape(w, body, ShapeKind::kCapsule, {0.1, 0, 0.4});
  Settings settings;
  settings.edge_radius_m = 0.001;
  const auto s = surface_traits(w, settings);
  using K = ContactKind;
  CHECK(curvature(s[0], K::kPoint, {0, 0, 0.05}, -1) == Approx(20));
  CHECK(curvature(s[1], K::kPoint, {0.02, 0.01, 0.1}, -1) == 0);
  CHECK(curvature(s[1], K::kPoint, {0.1, 0.01, 0.1}, -1) == Approx(500));
  CHECK(curvature(s[1], K::kPoint, {0.1, 0.1, 0.1}, -1) == Approx(1000));
  CHECK(curvature(s[1], K::kSurface, {0.1, 0.1, 0.1}, -1) == 0);
  CHECK(curvature(s[2], K::kEdge, {0.1, 0, 0}, -1) == Approx(5));
  CHECK(curvature(s[2], K::kPoint, {0.02, 0, 0.2}, -1) == 0);
  CHECK(curvature(s[3], K::kPoint, {0.1, 0, 0}, -1) == Approx(5));
  CHECK(curvature(s[3], K::kPoint, {0, 0, 0.3}, -1) == Approx(10));
}

TEST_CASE("The triangles of a ball have the curvature of the ball") {
  // An octahedron whose faces are divided in four, three times, and projected to the sphere.
  TriangleMesh mesh;
  mesh.vertices = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  mesh.indices = {0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5};
  for (int level = 0; level < 3; ++level) {
    std::vector<int> finer;
    for (std::size_t t = 0; t < mesh.indices.size(); t += 3) {
      const int a = mesh.indices[t], b = mesh.indices[t + 1], c = mesh.indices[t + 2];
      const int n = static_cast<int>(mesh.vertices.size());
      const auto middle = [&](int i, int j) {
        return Vector3d((mesh.vertices[static_cast<std::size_t>(i)] + mesh.vertices[static_cast<std::size_t>(j)]).normalized());
      };
      mesh.vertices.insert(mesh.vertices.end(), {middle(a, b), middle(b, c), middle(c, a)});
      for (const int i : {a, n, n + 2, n, b, n + 1, n + 2, n + 1, c, n, n + 1, n + 2}) finer.push_back(i);
    }
    mesh.indices = finer;
  }
  mesh.normals = mesh.vertices;
  for (Vector3d& v : mesh.vertices) v *= 0.04;
  for (const double c : triangle_curvatures(mesh)) CHECK(c == Approx(25).epsilon(1e-9));
}
