#include "sim_node/collision/detector.h"

#include <catch2/catch.hpp>

#include "sim_node/collision/closest_surface.h"
#include "tests/sim_node/support/detectors.h"
#include "tests/sim_node/support/meshes.h"

using namespace tactus::sim;
using namespace tactus::sim::test;
using Eigen::Isometry3d;
using Eigen::Vector3d;

namespace {

ShapeDef shape(ShapeKind kind, const Vector3d& size, int mesh = -1) {
  ShapeDef s;
  s.name = "thing";
  s.kind = kind;
  s.size_m = size;
  s.mesh = mesh;
  return s;
}

TriangleMesh mesh(const Soup& s) { return {s.vertices, {}, s.indices}; }

WorldDef world_of_meshes() {
  WorldDef w;
  w.meshes = {mesh(box({0.1, 0.08, 0.06})), mesh(comb(3, 0.1))};
  return w;
}

std::vector<std::unique_ptr<Detector>> built_in() {
  std::vector<std::unique_ptr<Detector>> all;
  for (const std::string_view name : kDetectors)
    if (name != "fcl" || make_fcl_detector()) all.push_back(make_detector(name));
  return all;
}

const Vector3d kSize(0.1, 0.06, 0.12);

}  // namespace

TEST_CASE("Each detector returns the geometric distance of a ball to each supported primitive") {
  const double r = 0.03, reach = 0.004;
  const WorldDef world;
  for (auto& detector : built_in()) {
    const DetectorAbilities can = detector->abilities();
    for (const ShapeKind kind : {ShapeKind::kBox, ShapeKind::kSphere, ShapeKind::kCylinder, ShapeKind::kCapsule}) {
      if (!detector->unsupported_reason(kind, ShapeKind::kSphere).empty()) continue;
      const ShapeDef def = shape(kind, kSize);
      const ClosestSurface surface(def, nullptr);
      const int thing = detector->add(def, world),
                ball = detector->add(shape(ShapeKind::kSphere, {r, 0, 0}), world);
      Random random(5);
      std::vector<SurfacePlane> planes;
      std::vector<PointPair> found;
      int apart = 0, overlapping = 0, far = 0;
      for (int i = 0; i < 600; ++i) {
        const Isometry3d pose = random_pose(random, 1);
        const Vector3d place = uniform(random, 0.05, 0.2) * direction(random);
        surface.query(place, 10, planes);
        const double gap = planes[0].distance_m - r;
        // Results deep inside and at the limit of the reach are not specified.
        if (planes[0].distance_m < 0.01 || std::abs(gap) < 1e-4 || std::abs(gap - reach) < 0.2 * reach) continue;
        const bool swapped = i % 2;
        const Isometry3d of_ball(pose * Eigen::Translation3d(place));
        if (swapped)
          detector->query(ball, of_ball, thing, pose, reach, found);
        else
          detector->query(thing, pose, ball, of_ball, reach, found);
        INFO(can.name << " kind " << static_cast<int>(kind) << " gap " << gap << " place " << place.transpose());
        if (gap > reach || (gap > 0 && !can.separation)) {
          CHECK(found.empty());
          far += gap > reach;
          continue;
        }
        REQUIRE(found.size() >= 1);
        const PointPair& p = *std::min_element(
            found.begin(), found.end(), [](const PointPair& x, const PointPair& y) { return x.gap_m < y.gap_m; });
        const Vector3d n = pose.linear() * planes[0].normal * (swapped ? -1 : 1);
        if (can.minimum_translation) {
          // Accuracy of iterative detectors: 0.1 mm. Our own detector has a separate oracle.
          CHECK(p.gap_m == Approx(gap).margin(1e-4));
          CHECK(p.normal.dot(n) > 0.98);
        } else {
          CHECK(p.gap_m <= gap + 1e-4);
          CHECK(p.normal.dot(n) > 0);
        }
        if (can.both_surfaces && gap > 0) {
          const Vector3d on_thing = pose.inverse() * (swapped ? p.on_b_m : p.on_a_m);
          surface.query(on_thing, 10, planes);
          CHECK(std::abs(planes[0].distance_m) < 1e-4);
        }
        (gap > 0 ? apart : overlapping)++;
      }
      INFO(can.name << " kind " << static_cast<int>(kind) << ": " << apart << " apart, " << overlapping
                    << " overlapping");
      CHECK((apart > 3 || !can.separation));
      CHECK(overlapping > 10);
      CHECK(far > 10);
    }
  }
}

TEST_CASE("Detectors that report gaps agree for random boxes, hulls and triangles") {
  const WorldDef world = world_of_meshes();
  auto ccd = make_detector("ccd"), layers = make_detector("layers");
  const ShapeDef one = shape(ShapeKind::kBox, {0.1, 0.08, 0.06}), hull = shape(ShapeKind::kMesh, {1, 1, 1}, 0);
  for (Detector* d : {ccd.get(), layers.get()}) {
    d->add(one, world);
    d->add(hull, world);
  }
  Random random(6);
  int compared = 0;
  for (int i = 0; i < 1000; ++i) {
    Isometry3d pose = random_pose(random, 1);
    pose.translation() = uniform(random, 0.07, 0.12) * direction(random);
    const double reach = 0.01;
    std::vector<PointPair> gjk, ours;
    ccd->query(0, Isometry3d::Identity(), 1, pose, reach, gjk);
    layers->query(0, Isometry3d::Identity(), 1, pose, reach, ours);
    bool pierced = false;
    double least = 1e300;
    for (const PointPair& p : ours) least = std::min(least, p.gap_m), pierced |= p.pierced;
    INFO("pose " << i << " least " << least);
    if (pierced) {
      REQUIRE(gjk.size() == 1);
      CHECK(gjk[0].gap_m < 1e-5);
    } else if (least < reach - 1e-4) {
      REQUIRE(gjk.size() == 1);
      CHECK(gjk[0].gap_m == Approx(least).margin(2e-5));
      ++compared;
    } else if (least > reach + 1e-4) {
      CHECK(gjk.empty());
    }
  }
  CHECK(compared > 50);
}

TEST_CASE("A detector rejects unsupported shapes at start-up and suggests an alternative") {
  const WorldDef world = world_of_meshes();
  CHECK_THROWS_WITH(make_detector("opcode"), Catch::Contains("unknown"));
  for (auto& detector : built_in())
    for (const ShapeKind a : {ShapeKind::kBox, ShapeKind::kSphere, ShapeKind::kPlane, ShapeKind::kMesh})
      for (const ShapeKind b : {ShapeKind::kBox, ShapeKind::kCylinder, ShapeKind::kCapsule, ShapeKind::kMesh}) {
        const std::string why = detector->unsupported_reason(a, b);
        CHECK(why.empty() == detector->unsupported_reason(b, a).empty());
        if (why.empty()) continue;
        CHECK(detector->abilities().name != "ode");
        CHECK_THAT(why,
                   Catch::Contains(std::string(detector->abilities().name)) && Catch::Contains("choose \"ode\""));
      }
  CHECK_FALSE(make_detector("ode")->unsupported_reason(ShapeKind::kPlane, ShapeKind::kHeightfield).empty());
  CHECK_THROWS_WITH(make_detector("ccd")->add(shape(ShapeKind::kMesh, {1, 1, 1}, 1), world),
                    Catch::Contains("convex meshes only"));
  CHECK_NOTHROW(make_detector("ccd")->add(shape(ShapeKind::kMesh, {1, 1, 1}, 0), world));
  CHECK_THROWS_WITH(make_detector("layers")->add(shape(ShapeKind::kSphere, {1, 1, 1}), world),
                    Catch::Contains("choose"));
  WorldDef soup;
  soup.meshes = {mesh(t_junctions(1))};
  CHECK_THROWS_WITH(make_detector("layers", {.remover = DuplicateRemover::kAdjacency})
                        ->add(shape(ShapeKind::kMesh, {1, 1, 1}, 0), soup),
                    Catch::Contains("hashed remover"));
}

TEST_CASE("A deterministic detector repeats a query bit-identically, with other queries between") {
  const WorldDef world = world_of_meshes();
  for (auto& detector : built_in()) {
    if (!detector->abilities().deterministic) continue;
    for (const ShapeKind kind : {ShapeKind::kBox, ShapeKind::kMesh}) {
      if (!detector->unsupported_reason(kind, kind).empty()) continue;
      const int a = detector->add(shape(kind, kSize, 0), world), b = detector->add(shape(kind, kSize, 0), world);
      Random random(8);
      for (int i = 0; i < 20; ++i) {
        Isometry3d pose = random_pose(random, 1), other = random_pose(random, 0.1);
        pose.translation() = 0.07 * direction(random);
        std::vector<PointPair> first, between, again;
        detector->query(a, Isometry3d::Identity(), b, pose, 0.002, first);
        detector->query(b, other, a, pose, 0.01, between);
        detector->query(a, Isometry3d::Identity(), b, pose, 0.002, again);
        REQUIRE(first.size() == again.size());
        for (std::size_t k = 0; k < first.size(); ++k) {
          CHECK(first[k].on_a_m == again[k].on_a_m);
          CHECK(first[k].normal == again[k].normal);
          CHECK(first[k].gap_m == again[k].gap_m);
        }
      }
    }
  }
}
