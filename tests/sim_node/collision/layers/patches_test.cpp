#include "sim_node/collision/layers/patches.h"

#include "lcmtypes/turn_between.h"
#include "tests/sim_node/support/contact_check.h"

using namespace tactus::sim;
using namespace tactus::sim::test;
using Eigen::Isometry3d;
using Eigen::Vector3d;

namespace {

std::vector<PointPair> touching(const Soup& a, const Soup& b, const Isometry3d& pose, double tolerance = 1e-3) {
  MeshContact contact;
  MeshContactResult found;
  contact.query(ContactMesh(a.vertices, a.indices), Isometry3d::Identity(), ContactMesh(b.vertices, b.indices),
                pose, {tolerance, tolerance / 2}, found);
  return found.pairs;
}

std::vector<ContactPatch> patches_of(const std::vector<PointPair>& pairs, double tolerance = 1e-3) {
  std::vector<ContactPatch> out;
  Patches patches;
  patches.make(pairs, tolerance, out);
  return out;
}

}  // namespace

TEST_CASE("Two plates have one patch of four corners with one stiffness at any resolution") {
  for (const int n : {1, 2, 5, 12}) {
    const Soup lower = plate(0.2, 0.2, n, n + 1), upper = plate(0.1, 0.06, n + 2, n);
    const auto pairs = touching(lower, upper, Isometry3d(Eigen::Translation3d(0.01, 0.02, 3e-4)));
    const auto patches = patches_of(pairs);
    INFO("n " << n << ", " << pairs.size() << " pairs");
    REQUIRE(patches.size() == 1);
    const ContactPatch& p = patches[0];
    CHECK(p.kind == ContactKind::kSurface);
    CHECK(p.area_m2 == Approx(0.1 * 0.06));
    REQUIRE(p.count == 4);
    CHECK(p.count * p.share() == Approx(1));
    Vector3d centre(0, 0, 0);
    for (const PointPair& point : p.points) {
      centre += p.share() * point.on_a_m;
      CHECK(std::abs(std::abs(point.on_a_m.x() - 0.01) - 0.05) < 1e-6);
      CHECK(std::abs(std::abs(point.on_a_m.y() - 0.02) - 0.03) < 1e-6);
      CHECK(point.gap_m == Approx(3e-4));
    }
    CHECK((centre - Vector3d(0.01, 0.02, 0)).norm() < 1e-6);
  }
}

TEST_CASE("A cube on an edge, on a corner or between two walls has edge, point or surface patches") {
  const Soup floor = plate(0.2, 0.2, 4, 4), cube = box({0.04, 0.04, 0.04});
  const double half_diagonal = 0.02 * std::sqrt(2.0);
  Isometry3d on_edge(Eigen::Translation3d(0.003, 0.001, half_diagonal + 2e-4));
  on_edge.rotate(Eigen::AngleAxisd(M_PI / 4, Vector3d::UnitX()));
  const auto edge = patches_of(touching(floor, cube, on_edge));
  REQUIRE(edge.size() >= 1);
  CHECK(edge[0].kind == ContactKind::kEdge);
  CHECK(edge[0].normal.z() == Approx(1));
  CHECK(edge[0].count == 2);

  Isometry3d on_corner(Eigen::Translation3d(0.003, 0.001, 0.02 * std::sqrt(3.0) + 2e-4));
  on_corner.rotate(tactus::turn_between(Vector3d(1, 1, 1), -Vector3d::UnitZ()));
  const auto corner = patches_of(touching(floor, cube, on_corner));
  REQUIRE(corner.size() >= 1);
  CHECK(corner[0].kind == ContactKind::kPoint);
  CHECK(corner[0].count == 1);

  Soup walls = plate(0.2, 0.2, 3, 3);
  Isometry3d wall(Eigen::Translation3d(0.1, 0, 0.1));
  wall.rotate(Eigen::AngleAxisd(M_PI / 2, Vector3d::UnitY()));
  walls.add(plate(0.2, 0.2, 2, 5), wall);
  const auto both =
      patches_of(touching(walls, cube, Isometry3d(Eigen::Translation3d(0.08 - 3e-4, 0, 0.02 + 2e-4))));
  int surfaces = 0;
  for (const ContactPatch& p : both) surfaces += p.kind == ContactKind::kSurface;
  CHECK(surfaces == 2);
  CHECK(both[0].points[0].gap_m == Approx(2e-4));
}

TEST_CASE("Patches do not depend on the order of pairs and cover every contact direction") {
  const Soup a = lumpy_sphere(3, 0.1, 1), b = lumpy_sphere(3, 0.1, 2);
  Random random(3);
  int compared = 0;
  for (int i = 0; i < 20; ++i) {
    Isometry3d pose = random_pose(random, 1);
    pose.translation() = uniform(random, 0.18, 0.2) * direction(random);
    std::vector<PointPair> pairs = touching(a, b, pose);
    const auto patches = patches_of(pairs);
    for (std::size_t k = pairs.size(); k > 1; --k) std::swap(pairs[k - 1], pairs[random() % k]);
    const auto again = patches_of(pairs);
    REQUIRE(again.size() == patches.size());
    for (std::size_t k = 0; k < patches.size(); ++k) {
      CHECK(again[k].count == patches[k].count);
      CHECK(again[k].normal == patches[k].normal);
      CHECK(again[k].points[0].on_a_m == patches[k].points[0].on_a_m);
    }
    // Every pair is represented: by a patch of its direction, or by one along whose normal its gap is at least as
    // large.
    for (const PointPair& p : pairs)
      CHECK(std::any_of(patches.begin(), patches.end(), [&](const ContactPatch& patch) {
        const double along = patch.normal.dot(p.normal), least = patch.points[0].gap_m - 2e-6;
        return along >= std::cos(kPatchAngle_rad) ? least <= p.gap_m : least <= along * p.gap_m;
      }));
    // The first patch has the least gap.
    if (!pairs.empty())
      CHECK(patches[0].points[0].gap_m <=
            1e-6 + std::min_element(pairs.begin(), pairs.end(), [](const PointPair& x, const PointPair& y) {
                     return x.gap_m < y.gap_m;
                   })->gap_m);
    compared += static_cast<int>(patches.size());
  }
  CHECK(compared > 10);
}
