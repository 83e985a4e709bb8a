#include "sim_node/scene/mass.h"

#include <catch2/catch.hpp>
#include <numbers>
#include <random>

#include "sim_node/scene/shapes.h"

using namespace tactus::sim;
using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {
constexpr double kPi = std::numbers::pi;

ShapeDef shape(ShapeKind kind, const Vector3d& size) {
  ShapeDef s;
  s.kind = kind, s.size_m = size, s.material = 0;
  return s;
}
WorldDef world_of_density(double density) {
  WorldDef w;
  w.materials.resize(1);
  w.materials[0].density_kg_m3 = density;
  return w;
}
bool inside(const ShapeDef& s, const Vector3d& p) {
  const double r = s.size_m.x(), h = s.size_m.z() / 2, rho = std::hypot(p.x(), p.y());
  if (s.kind == ShapeKind::kCylinder) return rho <= r && std::abs(p.z()) <= h;
  return std::hypot(rho, std::max(0.0, std::abs(p.z()) - h)) <= r;
}
}  // namespace

TEST_CASE("Mass and inertia of the primitives match their closed forms") {
  WorldDef w = world_of_density(1000);
  bool dense = false;
  const auto of = [&](const ShapeDef& s) { return mass_of(w, std::span(&s, 1), dense); };
  const MassProperties box = of(shape(ShapeKind::kBox, {0.1, 0.2, 0.3}));
  CHECK(dense);
  CHECK(box.mass_kg == Approx(6));
  CHECK((box.inertia_kg_m2.diagonal() - 0.5 * Vector3d(0.13, 0.10, 0.05)).norm() < 1e-12);
  const MassProperties ball = of(shape(ShapeKind::kSphere, {0.1, 0, 0}));
  CHECK(ball.mass_kg == Approx(1000 * 4.0 / 3 * kPi * 1e-3));
  CHECK(ball.inertia_kg_m2(0, 0) == Approx(0.4 * ball.mass_kg * 0.01));
}

TEST_CASE("Inertia of cylinder and capsule matches a sum over random points") {
  WorldDef w = world_of_density(1);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> u(-1, 1);
  constexpr int kPoints = 400'000;
  bool dense = false;
  for (const ShapeKind kind : {ShapeKind::kCylinder, ShapeKind::kCapsule}) {
    const ShapeDef s = shape(kind, {0.3, 0, 0.8});
    const Vector3d half(0.3, 0.3, 0.7);
    double mass = 0, xx = 0, zz = 0;
    for (int i = 0; i < kPoints; ++i) {
      const Vector3d p(half.x() * u(random), half.y() * u(random), half.z() * u(random));
      if (!inside(s, p)) continue;
      mass += 1, xx += p.y() * p.y() + p.z() * p.z(), zz += p.x() * p.x() + p.y() * p.y();
    }
    const double dv = 8 * half.prod() / kPoints;
    const MassProperties m = mass_of(w, std::span(&s, 1), dense);
    // The relative error of a mean over n points is about 1/sqrt(n) = 0.2 %; five times that.
    CHECK(m.mass_kg == Approx(mass * dv).epsilon(0.01));
    CHECK(m.inertia_kg_m2(0, 0) == Approx(xx * dv).epsilon(0.01));
    CHECK(m.inertia_kg_m2(2, 2) == Approx(zz * dv).epsilon(0.01));
  }
}

TEST_CASE("A mesh of a box has the mass of the box at any pose") {
  WorldDef w = world_of_density(700);
  TriangleMesh cube;
  for (int i = 0; i < 8; ++i) cube.vertices.emplace_back(i & 1 ? 0.3 : 0.1, i & 2 ? 0.5 : 0.1, i & 4 ? 0.2 : 0.1);
  cube.indices = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4, 2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
  w.meshes.push_back(cube);
  ShapeDef mesh = shape(ShapeKind::kMesh, {1, 1, 1}), box = shape(ShapeKind::kBox, {0.2, 0.4, 0.1});
  mesh.mesh = 0;
  mesh.pose = Eigen::Translation3d(1, -2, 0.5) * Eigen::AngleAxisd(1.1, Vector3d(1, 1, 2).normalized());
  box.pose = mesh.pose * Eigen::Translation3d(0.2, 0.3, 0.15);
  bool dense = false;
  const MassProperties a = mass_of(w, std::span(&mesh, 1), dense), b = mass_of(w, std::span(&box, 1), dense);
  CHECK(a.mass_kg == Approx(b.mass_kg).epsilon(1e-9));
  CHECK((a.centre_of_mass_m - b.centre_of_mass_m).norm() < 1e-9);
  CHECK((a.inertia_kg_m2 - b.inertia_kg_m2).norm() < 1e-9);
}

TEST_CASE("A body of two boxes equals one box of twice the length") {
  const WorldDef w = world_of_density(500);
  std::vector<ShapeDef> halves(2, shape(ShapeKind::kBox, {0.5, 0.2, 0.1}));
  halves[0].pose.translation() = Vector3d(-0.25, 0, 0), halves[1].pose.translation() = Vector3d(0.25, 0, 0);
  const ShapeDef whole = shape(ShapeKind::kBox, {1, 0.2, 0.1});
  bool dense = false;
  const MassProperties a = mass_of(w, halves, dense), b = mass_of(w, std::span(&whole, 1), dense);
  CHECK(a.mass_kg == Approx(b.mass_kg));
  CHECK((a.inertia_kg_m2 - b.inertia_kg_m2).norm() < 1e-12);
}

TEST_CASE("A sheet has the mass of its bounding box, which is reported") {
  WorldDef w = world_of_density(1000);
  TriangleMesh sheet;
  sheet.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  sheet.indices = {0, 1, 2};
  w.meshes.push_back(sheet);
  ShapeDef s = shape(ShapeKind::kMesh, {1, 1, 1});
  s.mesh = 0;
  bool dense = false;
  std::vector<MassRemark> remarks;
  const MassProperties m = mass_of(w, std::span(&s, 1), dense, &remarks);
  CHECK(m.mass_kg == Approx(0.1));  // 1 m x 1 m x 0.1 mm
  REQUIRE(remarks.size() == 1);
  CHECK_THAT(remarks[0].clause, Catch::Contains("bounding box"));
  CHECK(m.inertia_kg_m2.ldlt().isPositive());
}
