#include "sim_node/collision/closest_surface.h"

#include <catch2/catch.hpp>
#include <random>

#include "tests/sim_node/support/small_worlds.h"

using namespace tactus::sim;
using namespace tactus::sim::test;
using Eigen::Vector3d;

namespace {

ShapeDef solid_shape(ShapeKind kind, const Vector3d& size) {
  ShapeDef s;
  s.body = 0;
  s.kind = kind;
  s.size_m = size;
  return s;
}

// The surface of a box with n x n squares per side, two triangles each.
TriangleMesh box_mesh(const Vector3d& size, int n) {
  TriangleMesh m;
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0}) {
      const int first = static_cast<int>(m.vertices.size()), u = (axis + 1) % 3, v = (axis + 2) % 3;
      for (int i = 0; i <= n; ++i)
        for (int j = 0; j <= n; ++j) {
          Vector3d p;
          p[axis] = side * size[axis] / 2;
          p[u] = size[u] * (double(i) / n - 0.5);
          p[v] = size[v] * (double(j) / n - 0.5);
          m.vertices.push_back(p);
        }
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
          const int a = first + i * (n + 1) + j, b = a + n + 1;
          for (const int k : side > 0 ? std::array{a, b, a + 1, b, b + 1, a + 1} : std::array{a, a + 1, b, b, a + 1, b + 1})
            m.indices.push_back(k);
        }
    }
  m.normals.assign(m.vertices.size(), Vector3d::UnitZ());
  return m;
}

}  // namespace

TEST_CASE("The plane of a primitive is at its nearest point, as in an exhaustive search") {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> u(-1, 1);
  const Vector3d size(0.3, 0.2, 0.4);
  const ShapeKind kind = GENERATE(ShapeKind::kBox, ShapeKind::kSphere, ShapeKind::kCylinder, ShapeKind::kCapsule);
  const ClosestSurface surface(solid_shape(kind, size), nullptr);
  std::vector<SurfacePlane> planes;
  for (int i = 0; i < 2000; ++i) {
    const Vector3d p = 0.6 * Vector3d(u(random), u(random), u(random));
    surface.query(p, 10, planes);
    REQUIRE(planes.size() == 1);
    const SurfacePlane& s = planes[0];
    CHECK(s.normal.norm() == Approx(1));
    // The plane's point lies at the distance along the normal, and on the surface: its own distance is zero.
    CHECK((s.point + s.distance_m * s.normal - p).norm() < 1e-9);
    const double d = s.distance_m;
    surface.query(s.point + 1e-7 * s.normal, 10, planes);
    CHECK(planes[0].distance_m == Approx(1e-7).margin(1e-9));
    // The signed distance changes at most as fast as the position.
    const Vector3d q = p + 0.01 * Vector3d(u(random), u(random), u(random));
    surface.query(q, 10, planes);
    CHECK(std::abs(planes[0].distance_m - d) <= (q - p).norm() + 1e-12);
    CHECK(p.norm() - surface.bound_m() <= d + 1e-12);
  }
}

TEST_CASE("A box of triangles has the planes of a box at any resolution") {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> u(-1, 1);
  const Vector3d size(0.1, 0.08, 0.06);
  const ClosestSurface solid(solid_shape(ShapeKind::kBox, size), nullptr);
  for (const int n : {1, 7}) {
    const TriangleMesh mesh = box_mesh(size, n);
    const ClosestSurface soup(solid_shape(ShapeKind::kMesh, size), std::make_shared<const TriangleTree>(mesh.vertices, mesh.indices));
    std::vector<SurfacePlane> planes, exact;
    int compared = 0;
    for (int i = 0; i < 4000; ++i) {
      const Vector3d p = 0.08 * Vector3d(u(random), u(random), u(random));
      solid.query(p, 0.015, exact);
      if (exact.empty() || exact[0].distance_m < -0.01) continue;
      // Inside, where two faces are equally near, either may be reported.
      if (exact[0].distance_m < 0) continue;
      soup.query(p, 0.015, planes);
      INFO("n " << n << " at " << p.transpose() << " distance " << exact[0].distance_m);
      REQUIRE_FALSE(planes.empty());
      CHECK(planes[0].distance_m == Approx(exact[0].distance_m).margin(1e-9));
      if (exact[0].distance_m > 1e-6) CHECK((planes[0].normal - exact[0].normal).norm() < 1e-6);
      // Convex: no other plane may cut into the free space.
      CHECK(planes.size() == 1);
      ++compared;
    }
    CHECK(compared > 500);
  }
}

TEST_CASE("Just inside a mesh the nearest face gives the plane") {
  const Vector3d size(0.1, 0.08, 0.06);
  const TriangleMesh mesh = box_mesh(size, 5);
  const ClosestSurface soup(solid_shape(ShapeKind::kMesh, size), std::make_shared<const TriangleTree>(mesh.vertices, mesh.indices));
  std::vector<SurfacePlane> planes;
  soup.query({0.012, 0.003, 0.029}, 0.01, planes);
  REQUIRE(planes.size() == 1);
  CHECK(planes[0].distance_m == Approx(-0.001));
  CHECK(planes[0].normal.z() == Approx(1));
}

TEST_CASE("A concave edge of a mesh has both of its planes") {
  // A floor at z = 0 and a wall at x = 0, in one mesh, each of several triangles.
  TriangleMesh mesh;
  const auto square = [&](const Vector3d& o, const Vector3d& a, const Vector3d& b) {
    const int f = static_cast<int>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), {o, o + a, o + a + b, o + b});
    for (const int i : {0, 1, 2, 0, 2, 3}) mesh.indices.push_back(f + i);
  };
  for (int i = 0; i < 4; ++i) {
    square({0.01 * i, -0.05, 0}, {0.01, 0, 0}, {0, 0.1, 0});
    square({0, -0.05, 0.01 * i}, {0, 0.1, 0}, {0, 0, 0.01});
  }
  mesh.normals.assign(mesh.vertices.size(), Vector3d::UnitZ());
  const ClosestSurface corner(solid_shape(ShapeKind::kMesh, {1, 1, 1}), std::make_shared<const TriangleTree>(mesh.vertices, mesh.indices));
  std::vector<SurfacePlane> planes;
  for (const double x : {0.002, 0.005, 0.013})
    for (const double z : {0.003, 0.008}) {
      corner.query({x, 0.001, z}, 0.02, planes);
      INFO(x << " " << z);
      REQUIRE(planes.size() == 2);
      const SurfacePlane& floor = planes[z < x ? 0 : 1];
      const SurfacePlane& wall = planes[z < x ? 1 : 0];
      CHECK(floor.distance_m == Approx(z));
      CHECK(wall.distance_m == Approx(x));
      CHECK(floor.normal.z() == Approx(1));
      CHECK(wall.normal.x() == Approx(1));
    }
}
