#include <algorithm>
#include <catch2/catch.hpp>

#include "sim_node/collision/detector.h"
#include "tests/sim_node/support/meshes.h"
#include "tests/sim_node/support/triangle_oracle.h"

using namespace tactus::sim;
using namespace tactus::sim::test;
using Eigen::Isometry3d;
using Eigen::Vector3d;

namespace {

ShapeDef shape_of(ShapeKind kind, const Vector3d& size, int mesh = -1) {
  ShapeDef s;
  s.kind = kind;
  s.size_m = size;
  s.mesh = mesh;
  return s;
}

TriangleMesh mesh_of(const Soup& s) { return {s.vertices, {}, s.indices}; }

const PointPair& least_of(const std::vector<PointPair>& found) {
  return *std::min_element(found.begin(), found.end(),
                           [](const PointPair& x, const PointPair& y) { return x.gap_m < y.gap_m; });
}

Corners corners(const Soup& s, int i, const Isometry3d& pose) {
  return {pose * s.corner(i, 0), pose * s.corner(i, 1), pose * s.corner(i, 2)};
}

double brute_force(const Soup& a, const Isometry3d& pose_a, const Soup& b, const Isometry3d& pose_b) {
  double best = 1e300;
  for (int i = 0; i < a.triangles(); ++i)
    for (int j = 0; j < b.triangles(); ++j)
      best = std::min(best, exact_distance(corners(a, i, pose_a), corners(b, j, pose_b)));
  return best;
}

// Inscribed prism of n sides.
Soup prism(double r, double length, int n) {
  Soup s;
  for (int i = 0; i < n; ++i) {
    const double a = 2 * M_PI * i / n, b = 2 * M_PI * (i + 1) / n, z = length / 2;
    const Vector3d p(r * std::cos(a), r * std::sin(a), z), q(r * std::cos(b), r * std::sin(b), z), up(0, 0, 2 * z);
    s.add(p, q, {0, 0, z});
    s.add(q - up, p - up, {0, 0, -z});
    s.add(p - up, q, p);
    s.add(p - up, q - up, q);
  }
  return s;
}

}  // namespace

TEST_CASE("The gap of a body to a mesh is the least over all triangles") {
  struct Case {
    ShapeDef def;
    Soup soup;       // its core as triangles
    double round_m;  // rounding radius of the core
    double error_m;
  };
  Soup point, segment;
  point.add(Vector3d::Zero(), Vector3d::Zero(), Vector3d::Zero());
  segment.add({0, 0, -0.05}, {0, 0, 0.05}, {0, 0, 0.05});
  const Case cases[] = {{shape_of(ShapeKind::kSphere, {0.03, 0, 0}), point, 0.03, 1e-9},
                        {shape_of(ShapeKind::kCapsule, {0.02, 0, 0.1}), segment, 0.02, 1e-8},
                        {shape_of(ShapeKind::kBox, {0.06, 0.04, 0.1}), box({0.06, 0.04, 0.1}), 0, 1e-8},
                        // The sides of the prism lie inside the cylinder by r (1 - cos(pi / 48)).
                        {shape_of(ShapeKind::kCylinder, {0.03, 0, 0.1}), prism(0.03, 0.1, 48), 0, 7e-5},
                        {shape_of(ShapeKind::kMesh, {1, 1, 1}, 1), comb(2, 0.1), 0, 1e-8}};
  const Soup lumpy = lumpy_sphere(0, 0.1, 3);
  WorldDef world;
  world.meshes = {mesh_of(lumpy), mesh_of(comb(2, 0.1))};
  for (const Case& c : cases) {
    auto gaps = make_detector("gaps");
    const int mesh = gaps->add(shape_of(ShapeKind::kMesh, {1, 1, 1}, 0), world), body = gaps->add(c.def, world);
    Random random(11);
    int apart = 0;
    for (int i = 0; i < 60; ++i) {
      const Isometry3d pose = random_pose(random, 1);
      Isometry3d on = random_pose(random, 0);
      on.pretranslate(uniform(random, 0.12, 0.2) * direction(random));
      on = pose * on;
      const double reach = 0.02;
      const double truth = brute_force(lumpy, pose, c.soup, on) - c.round_m;
      INFO("kind " << static_cast<int>(c.def.kind) << " pose " << i << " gap " << truth);
      std::vector<PointPair> found, swapped;
      gaps->query(mesh, pose, body, on, reach, found);
      gaps->query(body, on, mesh, pose, reach, swapped);
      REQUIRE(found.size() == swapped.size());
      if (truth > reach + c.error_m) REQUIRE(found.empty());
      if (truth > reach - c.error_m || truth <= 1e-4) continue;
      REQUIRE(!found.empty());
      CHECK(least_of(found).gap_m <= truth + 1e-8);
      CHECK(least_of(found).gap_m >= truth - c.error_m);
      CHECK(least_of(swapped).gap_m == Approx(least_of(found).gap_m).margin(1e-9));
      CHECK((least_of(swapped).normal + least_of(found).normal).norm() < 1e-5);
      for (const PointPair& p : found) {
        CHECK((p.on_b_m - p.on_a_m - p.gap_m * p.normal).norm() < 1e-9);
        REQUIRE(p.triangle_a >= 0);
        REQUIRE(p.triangle_a < lumpy.triangles());
        CHECK(exact_distance(p.on_a_m, corners(lumpy, p.triangle_a, pose)) < 1e-7);
      }
      ++apart;
    }
    CHECK(apart > 10);
  }
}

TEST_CASE("A body that slides over triangles does not catch on internal edges") {
  const Soup plain = plate(1, 1, 40, 40);
  WorldDef world;
  world.meshes = {mesh_of(plain), mesh_of(box({0.1, 0.1, 0.1}))};
  auto gaps = make_detector("gaps");
  const int floor = gaps->add(shape_of(ShapeKind::kMesh, {1, 1, 1}, 0), world);
  const ShapeDef def =
      GENERATE(shape_of(ShapeKind::kBox, {0.1, 0.1, 0.1}), shape_of(ShapeKind::kCylinder, {0.05, 0, 0.1}),
               shape_of(ShapeKind::kCapsule, {0.05, 0, 0.1}), shape_of(ShapeKind::kSphere, {0.05, 0, 0}),
               shape_of(ShapeKind::kMesh, {1, 1, 1}, 1));
  const double height = GENERATE(1e-5, 1e-3, -2e-6);
  const int body = gaps->add(def, world);
  Random random(4);
  for (int i = 0; i < 20; ++i) {
    Isometry3d pose = Isometry3d::Identity();
    pose.rotate(Eigen::AngleAxisd(uniform(random, 0, 6), Vector3d::UnitZ()));
    const double low = def.kind == ShapeKind::kCapsule ? 0.1 : 0.05;
    pose.translation() = Vector3d(uniform(random, -0.2, 0.2), uniform(random, -0.2, 0.2), low + height);
    std::vector<PointPair> found;
    gaps->query(floor, Isometry3d::Identity(), body, pose, 0.02, found);
    INFO("kind " << static_cast<int>(def.kind) << " height " << height << " at "
                 << pose.translation().transpose());
    REQUIRE(!found.empty());
    // Two intersecting meshes separate over the nearer face, which may be any face of a corner.
    const bool parted = height < 0 && def.kind == ShapeKind::kMesh;
    if (!parted) CHECK(least_of(found).gap_m == Approx(height).margin(1e-9));
    for (const PointPair& p : found)
      if (!parted) CHECK(p.normal.z() > 1 - 1e-6);
  }
}

TEST_CASE("A body in the corner of a mesh touches floor and wall") {
  Soup corner = plate(1, 1, 10, 10);
  Isometry3d wall = Isometry3d::Identity();
  wall.translate(Vector3d(0.3, 0, 0.3));
  wall.rotate(Eigen::AngleAxisd(-M_PI / 2, Vector3d::UnitY()));
  corner.add(plate(1, 1, 7, 7), wall);
  WorldDef world;
  world.meshes = {mesh_of(corner)};
  const double height = GENERATE(1e-5, -2e-6), aside = GENERATE(2e-5, -3e-6);
  const ShapeDef def =
      GENERATE(shape_of(ShapeKind::kBox, {0.1, 0.1, 0.1}), shape_of(ShapeKind::kCylinder, {0.05, 0, 0.1}),
               shape_of(ShapeKind::kSphere, {0.05, 0, 0}));
  auto gaps = make_detector("gaps");
  const int ground = gaps->add(shape_of(ShapeKind::kMesh, {1, 1, 1}, 0), world), body = gaps->add(def, world);
  std::vector<PointPair> found;
  gaps->query(ground, Isometry3d::Identity(), body,
              Isometry3d(Eigen::Translation3d(0.25 - aside, 0.013, 0.05 + height)), 0.001, found);
  double on_floor = 1, on_wall = 1;
  for (const PointPair& p : found) {
    if (p.normal.z() > 0.999) on_floor = std::min(on_floor, p.gap_m);
    if (p.normal.x() < -0.999) on_wall = std::min(on_wall, p.gap_m);
  }
  INFO("kind " << static_cast<int>(def.kind) << " height " << height << " aside " << aside);
  // A ball inside a surface gets the nearest face only.
  if (def.kind == ShapeKind::kSphere && (height < 0 || aside < 0)) {
    CHECK(std::min(on_floor, on_wall) == Approx(std::min(height, aside)).margin(1e-9));
    return;
  }
  CHECK(on_floor == Approx(height).margin(1e-8));
  CHECK(on_wall == Approx(aside).margin(1e-8));
}

TEST_CASE("Intersecting meshes have a direction that separates them") {
  WorldDef world;
  world.meshes = {mesh_of(box({0.2, 0.2, 0.2})), mesh_of(lumpy_sphere(2, 0.1, 5))};
  auto gaps = make_detector("gaps");
  const int block = gaps->add(shape_of(ShapeKind::kMesh, {1, 1, 1}, 0), world),
            ball = gaps->add(shape_of(ShapeKind::kMesh, {1, 1, 1}, 1), world);
  std::vector<PointPair> found;
  for (double height = 0.2; height > 0.18; height -= 0.002) {
    gaps->query(block, Isometry3d::Identity(), ball, Isometry3d(Eigen::Translation3d(0, 0, height)), 1e-3, found);
    if (found.empty() || least_of(found).gap_m > 0) continue;
    CHECK(least_of(found).normal.z() > 0.5);
    CHECK(least_of(found).gap_m > -0.03);
    return;
  }
  FAIL("the meshes never intersect");
}

TEST_CASE("A tilted body over triangles also has contacts at its far end") {
  const Soup plain = plate(1, 1, 40, 40);
  WorldDef world;
  world.meshes = {mesh_of(plain), mesh_of(box({0.1, 0.1, 0.1}))};
  auto gaps = make_detector("gaps");
  const int floor = gaps->add(shape_of(ShapeKind::kMesh, {1, 1, 1}, 0), world);
  const double tilt = 0.05, yaw = 0.3, height = 1e-3;
  const auto kind = GENERATE(ShapeKind::kBox, ShapeKind::kMesh, ShapeKind::kCapsule);
  const bool capsule = kind == ShapeKind::kCapsule;
  const int body = gaps->add(shape_of(kind, capsule ? Vector3d(0.02, 0, 0.1) : Vector3d(0.1, 0.1, 0.1), 1), world);
  Isometry3d pose = Isometry3d::Identity();
  pose.rotate(Eigen::AngleAxisd(yaw, Vector3d::UnitZ()));
  pose.rotate(Eigen::AngleAxisd(capsule ? M_PI / 2 - tilt : tilt, Vector3d::UnitY()));
  if (!capsule) pose.rotate(Eigen::AngleAxisd(tilt / 2, Vector3d::UnitX()));
  // Its lowest points, by their heights relative to its centre.
  std::vector<double> low;
  if (capsule) {
    low = {-0.05 * std::sin(tilt) - 0.02, 0.05 * std::sin(tilt) - 0.02};
  } else {
    for (int i = 0; i < 8; ++i)
      low.push_back((pose * Vector3d(i & 1 ? 0.05 : -0.05, i & 2 ? 0.05 : -0.05, i & 4 ? 0.05 : -0.05)).z());
    std::sort(low.begin(), low.end());
    low.resize(4);
  }
  pose.pretranslate(Vector3d(0.013, 0.007, height - low[0]));
  std::vector<PointPair> found;
  gaps->query(floor, Isometry3d::Identity(), body, pose, 0.02, found);
  for (const double z : low) {
    INFO("kind " << static_cast<int>(kind) << " point " << z - low[0] + height);
    CHECK(std::any_of(found.begin(), found.end(), [&](const PointPair& p) {
      return p.normal.z() > 1 - 1e-9 && std::abs(p.gap_m - (z - low[0] + height)) < 1e-9;
    }));
  }
}
