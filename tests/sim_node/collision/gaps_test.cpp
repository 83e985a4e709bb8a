#include <algorithm>
#include <catch2/catch.hpp>

#include "sim_node/collision/detector.h"
#include "tests/sim_node/support/convex_oracle.h"

using namespace tactus::sim;
using namespace tactus::sim::test;
using Eigen::Isometry3d;
using Eigen::Vector3d;

namespace {

constexpr ShapeKind kConvex[] = {ShapeKind::kBox, ShapeKind::kSphere, ShapeKind::kCylinder, ShapeKind::kCapsule};

ShapeDef convex(ShapeKind kind, const Vector3d& size) {
  ShapeDef s;
  s.kind = kind;
  s.size_m = size;
  return s;
}

ShapeDef random_shape(ShapeKind kind, Random& random) {
  return convex(kind, {uniform(random, 0.02, 0.1), uniform(random, 0.02, 0.1), uniform(random, 0.02, 0.2)});
}

const PointPair& least(const std::vector<PointPair>& found) {
  return *std::min_element(found.begin(), found.end(),
                           [](const PointPair& x, const PointPair& y) { return x.gap_m < y.gap_m; });
}

// Random poses, or poses with aligned faces, edges and axes, as of shapes that rest on each other.
Isometry3d turned(Random& random, int i) {
  Isometry3d pose = Isometry3d::Identity();
  if (i % 3 == 0) {
    const Vector3d axes[3] = {Vector3d::UnitX(), Vector3d::UnitY(), Vector3d::UnitZ()};
    pose.rotate(Eigen::AngleAxisd(M_PI / 2 * static_cast<double>(random() % 4), axes[random() % 3]));
    pose.rotate(Eigen::AngleAxisd(M_PI / 4 * static_cast<double>(random() % 8), axes[random() % 3]));
    return pose;
  }
  pose.rotate(Eigen::AngleAxisd(uniform(random, 0, 2 * M_PI), direction(random)));
  return pose;
}

}  // namespace

TEST_CASE("Witness points and a separating plane confirm the least gap of separated convex shapes") {
  const WorldDef world;
  for (const ShapeKind kind_a : kConvex)
    for (const ShapeKind kind_b : kConvex) {
      Random random(static_cast<unsigned>(kind_a) * 16 + static_cast<unsigned>(kind_b));
      int apart = 0, far = 0;
      for (int i = 0; i < 1500; ++i) {
        auto gaps = make_detector("gaps");
        const ShapeDef a = random_shape(kind_a, random), b = random_shape(kind_b, random);
        const int na = gaps->add(a, world), nb = gaps->add(b, world);
        const Isometry3d world_from = random_pose(random, 2);
        const Isometry3d pose_a = world_from * turned(random, i);
        Isometry3d pose_b = turned(random, i / 2);
        pose_b.pretranslate(uniform(random, 0, 0.3) * direction(random));
        pose_b = world_from * pose_b;
        const double reach = 0.02;
        std::vector<PointPair> found;
        gaps->query(na, pose_a, nb, pose_b, reach, found);
        INFO("kinds " << static_cast<int>(kind_a) << ' ' << static_cast<int>(kind_b) << " case " << i);
        if (found.empty()) {
          if (i % 5) continue;
          // The oracle's gap is at most the distance, which is the relevant bound here.
          REQUIRE(widest_gap(a, pose_a, b, pose_b, random) > reach - 1e-5);
          ++far;
          continue;
        }
        const PointPair& p = least(found);
        // 1e-9: rounding at 2 m from the origin, and the convergence limit of the search.
        REQUIRE(gap_along(a, pose_a, b, pose_b, p.normal) == Approx(p.gap_m).margin(1e-7));
        REQUIRE(p.gap_m <= reach + 1e-9);
        for (const PointPair& q : found) {
          REQUIRE((q.on_b_m - q.on_a_m - q.gap_m * q.normal).norm() < 1e-9);
          REQUIRE(q.normal.norm() == Approx(1));
          if (p.gap_m <= 0) continue;
          // Lines on round sides may be 0.1 mm beside each other.
          REQUIRE(lies_in(a, pose_a, q.on_a_m, 1e-6));
          REQUIRE(lies_in(b, pose_b, q.on_b_m, 1e-6));
        }
        apart += p.gap_m > 0;
      }
      CHECK(apart > 40);
      CHECK(far > 20);
    }
}

TEST_CASE("The penetration depth of overlapping convex shapes separates them and is minimal") {
  const WorldDef world;
  for (const ShapeKind kind_a : kConvex)
    for (const ShapeKind kind_b : kConvex) {
      Random random(99 + static_cast<unsigned>(kind_a) * 16 + static_cast<unsigned>(kind_b));
      int overlapping = 0;
      for (int i = 0; i < 600; ++i) {
        auto gaps = make_detector("gaps");
        const ShapeDef a = random_shape(kind_a, random), b = random_shape(kind_b, random);
        const int na = gaps->add(a, world), nb = gaps->add(b, world);
        const Isometry3d pose_a = turned(random, i);
        Isometry3d pose_b = turned(random, i / 2);
        pose_b.pretranslate(uniform(random, 0.01, 0.15) * direction(random));
        std::vector<PointPair> found;
        gaps->query(na, pose_a, nb, pose_b, 1e-3, found);
        if (found.empty() || least(found).gap_m >= 0) continue;
        const PointPair& p = least(found);
        INFO("kinds " << static_cast<int>(kind_a) << ' ' << static_cast<int>(kind_b) << " case " << i << " depth "
                      << -p.gap_m);
        REQUIRE(gap_along(a, pose_a, b, pose_b, p.normal) == Approx(p.gap_m).margin(1e-7));
        const double way_out = -widest_gap(a, pose_a, b, pose_b, random);
        // Deep inside a round shape there are many directions of nearly minimal depth.
        const bool round = kind_a == ShapeKind::kCylinder || kind_b == ShapeKind::kCylinder;
        REQUIRE(-p.gap_m <= (round ? 1.5 : 1.0) * way_out + 1e-5);
        ++overlapping;
      }
      CHECK(overlapping > 100);
    }
}
