#include "sim_node/model/mesh_solid.h"

#include <Eigen/Eigenvalues>
#include <catch2/catch.hpp>
#include <numbers>

#include "lcmtypes/turn_between.h"
#include "tests/sim_node/support/meshes.h"

using namespace tactus::sim;
using namespace tactus::sim::test;
using Eigen::Vector3d;

namespace {

TriangleMesh mesh_of(const Soup& soup) { return {soup.vertices, {}, soup.indices}; }

void turn_around(TriangleMesh& mesh, std::size_t triangle) { std::swap(mesh.indices[3 * triangle + 1], mesh.indices[3 * triangle + 2]); }
TriangleMesh inside_out(TriangleMesh mesh) {
  for (std::size_t t = 0; 3 * t < mesh.indices.size(); ++t) turn_around(mesh, t);
  return mesh;
}
TriangleMesh joined(TriangleMesh a, const TriangleMesh& b, const Vector3d& shift = Vector3d::Zero()) {
  const int first = static_cast<int>(a.vertices.size());
  for (const Vector3d& v : b.vertices) a.vertices.push_back(v + shift);
  for (const int i : b.indices) a.indices.push_back(first + i);
  return a;
}
// Each triangle with vertices of its own, as in STL.
TriangleMesh unwelded(const TriangleMesh& mesh) {
  TriangleMesh out;
  for (const int i : mesh.indices) {
    out.indices.push_back(static_cast<int>(out.vertices.size()));
    out.vertices.push_back(mesh.vertices[static_cast<std::size_t>(i)]);
  }
  return out;
}
TriangleMesh without_triangle(TriangleMesh mesh, std::size_t triangle) {
  const auto first = mesh.indices.begin() + static_cast<std::ptrdiff_t>(3 * triangle);
  mesh.indices.erase(first, first + 3);
  return mesh;
}
void check_equal(const VolumeIntegral& a, const VolumeIntegral& b, double relative) {
  CHECK(a.volume_m3 == Approx(b.volume_m3).epsilon(relative));
  CHECK((a.centroid_m - b.centroid_m).norm() <= relative * std::cbrt(b.volume_m3) + 1e-9 * b.centroid_m.norm());
  CHECK((a.inertia - b.inertia).norm() <= relative * b.inertia.norm());
}

}  // namespace

TEST_CASE("A closed mesh has the same solid whichever way its triangles face") {
  Random random(1);
  for (int round = 0; round < 60; ++round) {
    INFO(round);
    const TriangleMesh mesh = mesh_of(lumpy_sphere(1 + round % 3, uniform(random, 1e-3, 10), random()));
    const MeshSolid right = solid_of(mesh);
    CHECK(right.remark.empty());
    check_equal(right.integral, integrate(mesh), 1e-9);
    TriangleMesh other = round % 2 ? inside_out(mesh) : mesh;
    // Less than half of the triangles faces the other side.
    if (round % 3 == 0)
      for (std::size_t t = 0; 3 * t < other.indices.size(); ++t)
        if (uniform(random, 0, 1) < 0.3) turn_around(other, t);
    if (round % 4 == 0) other = unwelded(other);
    const MeshSolid turned = solid_of(other);
    CHECK(turned.remark.empty());
    check_equal(turned.integral, right.integral, 1e-9);
  }
}

TEST_CASE("A mirrored mesh has the mirrored solid") {
  const TriangleMesh mesh = mesh_of(lumpy_sphere(2, 0.1, 3));
  TriangleMesh mirrored = mesh;
  for (Vector3d& v : mirrored.vertices) v.z() = -v.z();
  const VolumeIntegral a = solid_of(mesh).integral, b = solid_of(mirrored).integral;
  CHECK(b.volume_m3 == Approx(a.volume_m3).epsilon(1e-12));
  CHECK(b.centroid_m.z() == Approx(-a.centroid_m.z()).margin(1e-15));
  CHECK(b.inertia(0, 0) == Approx(a.inertia(0, 0)).epsilon(1e-12));
}

TEST_CASE("A mesh far from the origin of its file keeps its inertia") {
  const TriangleMesh near = mesh_of(box({0.2, 0.1, 0.3}));
  TriangleMesh far = near;
  for (Vector3d& v : far.vertices) v += Vector3d(3e5, -2e5, 1e5);
  const MeshSolid solid = solid_of(far);
  // A coordinate of 3e5 m has steps of 6e-11 m, 6e-10 of 0.1 m; three lengths and two squares of lengths.
  CHECK(solid.integral.volume_m3 == Approx(0.006).epsilon(1e-8));
  CHECK((solid.integral.inertia - solid_of(near).integral.inertia).norm() < 1e-8 * solid.integral.inertia.norm());
  CHECK((solid.integral.centroid_m - Vector3d(3e5, -2e5, 1e5)).norm() < 1e-9);
  CHECK(solid.remark.empty());
}

TEST_CASE("Shells beside each other add, and shells inside that face the other way are cavities") {
  const TriangleMesh large = mesh_of(box({1, 1, 1})), small = mesh_of(box({0.5, 0.5, 0.5})), tiny = mesh_of(box({0.1, 0.1, 0.1}));
  const auto volume = [](const TriangleMesh& m) {
    const MeshSolid solid = solid_of(m);
    CHECK(solid.remark.empty());
    return solid.integral.volume_m3;
  };
  CHECK(volume(joined(large, small, {2, 0, 0})) == Approx(1.125));
  CHECK(volume(joined(large, inside_out(small), {2, 0, 0})) == Approx(1.125));
  CHECK(volume(joined(inside_out(large), small, {2, 0, 0})) == Approx(1.125));
  const TriangleMesh hollow = joined(large, inside_out(small));
  CHECK(volume(hollow) == Approx(0.875));
  CHECK(volume(inside_out(hollow)) == Approx(0.875));
  CHECK(volume(joined(hollow, tiny)) == Approx(0.876));
  CHECK(volume(inside_out(joined(hollow, tiny))) == Approx(0.876));
  CHECK(solid_of(hollow).integral.inertia(0, 0) == Approx((1 - 0.5 * 0.5 * 0.5 * 0.25) / 6));
}

TEST_CASE("Cubes that share an edge or a corner are two closed shells") {
  const TriangleMesh cube = mesh_of(box({1, 1, 1}));
  for (const Vector3d& shift : {Vector3d(1, 1, 0), Vector3d(1, 1, 1)})
    for (const bool reversed : {false, true}) {
      const MeshSolid solid = solid_of(joined(cube, reversed ? inside_out(cube) : cube, shift));
      CHECK(solid.remark.empty());
      CHECK(solid.integral.volume_m3 == Approx(2));
    }
}

TEST_CASE("An edge of any number of triangles takes time in proportion") {
  // A comparison of each triangle at the edge with all others takes minutes for these.
  constexpr int kTetrahedra = 100'000;
  constexpr double kAngle_rad = std::numbers::pi / kTetrahedra;
  TriangleMesh fan;
  fan.vertices = {{0, 0, 0}, {0, 0, 1}};
  const auto around = [](double angle) { return Vector3d(std::cos(angle), std::sin(angle), 0.5); };
  TriangleMesh closed = fan;
  for (int i = 0; i < kTetrahedra; ++i) {
    const int a = 2 + 2 * i, b = a + 1;
    for (const double angle : {2 * i * kAngle_rad, (2 * i + 1) * kAngle_rad}) closed.vertices.push_back(around(angle));
    for (const int k : {0, b, a, 1, a, b, 0, a, 1, 0, 1, b}) closed.indices.push_back(k);
  }
  fan.vertices = closed.vertices;
  for (int v = 2; v < 2 + 2 * kTetrahedra; ++v)
    for (const int k : {0, v, 1}) fan.indices.push_back(k);
  const MeshSolid solid = solid_of(closed);
  CHECK(solid.remark.empty());
  CHECK(solid.integral.volume_m3 == Approx(kTetrahedra * std::sin(kAngle_rad) / 6).epsilon(1e-9));
  CHECK(solid_of(fan).integral.volume_m3 > 0);
}

TEST_CASE("A thin diagonal rod has its own volume, not that of its bounding box") {
  TriangleMesh rod = mesh_of(box({1, 0.002, 0.002}));
  const Eigen::Quaterniond turn = tactus::turn_between(Vector3d::UnitX(), Vector3d(1, 1, 1));
  for (Vector3d& v : rod.vertices) v = turn * v;
  CHECK(solid_of(rod).integral.volume_m3 == Approx(4e-6));
  CHECK(solid_of(rod).remark.empty());
}

TEST_CASE("An opening is closed over its rim and reported") {
  const TriangleMesh cube = mesh_of(box({1, 1, 1}));
  for (std::size_t t = 0; 3 * t < cube.indices.size(); ++t) {
    for (const Vector3d& shift : {Vector3d(0, 0, 0), Vector3d(5, 7, -9)}) {
      TriangleMesh open = without_triangle(cube, t);
      for (Vector3d& v : open.vertices) v += shift;
      const MeshSolid solid = solid_of(t % 2 ? inside_out(open) : open);
      CHECK(solid.integral.volume_m3 == Approx(1));
      CHECK_THAT(solid.remark, Catch::StartsWith("is open (3 edges have"));
    }
  }
}

TEST_CASE("Walls inside, two-sided faces and split edges do not change the volume") {
  const TriangleMesh cube = mesh_of(box({1, 1, 1}));
  TriangleMesh wall = cube;
  wall.indices.insert(wall.indices.end(), {0, 3, 7, 0, 7, 4});  // across the cube, along two of its edges
  CHECK(solid_of(wall).integral.volume_m3 == Approx(1));
  CHECK_THAT(solid_of(wall).remark, Catch::Contains("is open"));
  const MeshSolid two_sided = solid_of(joined(cube, inside_out(cube)));
  CHECK(two_sided.integral.volume_m3 == Approx(1));
  CHECK(two_sided.remark.empty());
  // A face divided on one side of an edge only, as modelling programs export it.
  TriangleMesh split = cube;
  const int a = split.indices[0], b = split.indices[1], c = split.indices[2], middle = static_cast<int>(split.vertices.size());
  const auto at = [&](int i) { return split.vertices[static_cast<std::size_t>(i)]; };
  split.vertices.push_back(Vector3d((at(a) + at(b)) / 2));
  split = without_triangle(split, 0);
  split.indices.insert(split.indices.end(), {a, middle, c, middle, b, c});
  CHECK(solid_of(split).integral.volume_m3 == Approx(1));
  CHECK(solid_of(split).remark.empty());
}

TEST_CASE("A sheet, a one-sided strip and a mesh that overlaps itself count as their bounding box, which is reported") {
  TriangleMesh sheet;
  sheet.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  sheet.indices = {0, 1, 2};
  CHECK(solid_of(sheet).integral.volume_m3 == Approx(1e-4));
  CHECK_THAT(solid_of(sheet).remark, Catch::Contains("nearly no volume") || Catch::Contains("no volume"));
  TriangleMesh strip;
  constexpr int kSteps = 24;
  for (int i = 0; i < kSteps; ++i)
    for (const double side : {-0.2, 0.2}) {
      const double turn = 2 * std::numbers::pi * i / kSteps, r = 1 + side * std::cos(turn / 2);
      strip.vertices.emplace_back(r * std::cos(turn), r * std::sin(turn), side * std::sin(turn / 2));
    }
  for (int i = 0; i < kSteps; ++i) {
    const bool last = i + 1 == kSteps;
    const int a = 2 * i, b = a + 1, c = last ? 1 : a + 2, d = last ? 0 : a + 3;
    strip.indices.insert(strip.indices.end(), {a, c, b, b, c, d});
  }
  CHECK_THAT(solid_of(strip).remark, Catch::Contains("one-sided"));
  const TriangleMesh cube = mesh_of(box({1, 1, 1}));
  TriangleMesh shifted = cube;
  for (Vector3d& v : shifted.vertices) v *= 0.999;
  const MeshSolid twice = solid_of(joined(cube, shifted));
  CHECK(twice.integral.volume_m3 == Approx(1));
  CHECK_THAT(twice.remark, Catch::Contains("overlaps itself"));
}

TEST_CASE("Any soup of triangles has a finite solid of positive volume and inertia") {
  Random random(7);
  for (int round = 0; round < 400; ++round) {
    INFO(round);
    TriangleMesh mesh;
    const double scale = std::pow(10, uniform(random, -4, 5));
    const int vertices = 3 + static_cast<int>(random() % 20);
    for (int i = 0; i < vertices; ++i) {
      Vector3d v = scale * Vector3d(uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 1));
      if (round % 5 == 0) v.z() = 0;
      mesh.vertices.push_back(v);
    }
    for (int i = 0; i < 3 * (1 + round % 40); ++i) mesh.indices.push_back(static_cast<int>(random() % mesh.vertices.size()));
    remove_degenerate(mesh);
    if (mesh.indices.empty()) continue;
    const MeshSolid solid = solid_of(mesh);
    CHECK(solid.integral.volume_m3 > 0);
    CHECK(std::isfinite(solid.integral.volume_m3));
    CHECK(solid.integral.centroid_m.allFinite());
    const Vector3d moments = solid.integral.inertia.selfadjointView<Eigen::Lower>().eigenvalues();
    CHECK(moments.allFinite());
    CHECK(moments[0] > 0);
    CHECK(moments[2] <= 1.0001 * (moments[0] + moments[1]));
    CHECK(solid.integral.volume_m3 <= 1.01 * bounds(mesh, Eigen::Isometry3d::Identity()).sizes().cwiseMax(1e-4).prod());
  }
}
