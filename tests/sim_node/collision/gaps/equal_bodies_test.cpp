// Bodies of equal size that stand on each other, aligned or nearly: their sides are one plane, so that no edge passes inside a face.
#include <algorithm>
#include <catch2/catch.hpp>

#include "sim_node/collision/detector.h"
#include "tests/sim_node/support/meshes.h"
#include "tests/sim_node/support/toys.h"

using namespace tactus::sim;
using namespace tactus::sim::test;
using Eigen::Isometry3d;
using Eigen::Vector3d;

namespace {

constexpr double kSize_m = 0.1;

struct Stack {
  explicit Stack(bool box_below) : detector(make_detector("gaps")) {
    const Soup cube = box({kSize_m, kSize_m, kSize_m});
    world.meshes.push_back({cube.vertices, {}, cube.indices});
    ShapeDef mesh, solid;
    mesh.kind = ShapeKind::kMesh, mesh.mesh = 0, mesh.size_m = {1, 1, 1};
    solid.kind = ShapeKind::kBox, solid.size_m = {kSize_m, kSize_m, kSize_m};
    lower = detector->add(box_below ? solid : mesh, world);
    upper = detector->add(mesh, world);
  }
  // at: the frame of the stack; aside_m: of the upper body.
  std::vector<PointPair> contacts(const Isometry3d& at, double overlap_m, const Vector3d& aside_m) {
    std::vector<PointPair> found;
    const Isometry3d above = at * Eigen::Translation3d(aside_m + Vector3d(0, 0, kSize_m - overlap_m));
    detector->query(lower, at, upper, above, 2e-5, found);
    return found;
  }
  WorldDef world;
  std::unique_ptr<Detector> detector;
  int lower = -1, upper = -1;
};

}  // namespace

TEST_CASE("Equal bodies that overlap are pushed straight apart, aligned or nearly, mesh on mesh and on box") {
  const bool box_below = GENERATE(false, true);
  Stack stack(box_below);
  Random random(7);
  for (const double overlap_m : {1e-5, 1e-4, 1e-3})
    for (const double aside_m : {0.0, 1e-10, 1e-8, 3e-7, 1e-6, 3e-6, 1e-5, 1e-4})
      for (int turn = 0; turn < 6; ++turn) {
        Isometry3d at = Isometry3d::Identity();
        if (turn > 0) at = Eigen::Translation3d(direction(random)) * Eigen::AngleAxisd(uniform(random, 0, 3), direction(random));
        const double angle = uniform(random, 0, 2 * M_PI);
        const Vector3d aside = aside_m * Vector3d(std::cos(angle), std::sin(angle), 0);
        const auto found = stack.contacts(at, overlap_m, turn == 1 ? Vector3d(aside_m, 0, 0) : aside);
        INFO("box " << box_below << " overlap " << overlap_m << " aside " << aside_m << " turn " << turn << ", " << found.size() << " contacts");
        // Sides that are apart by aside_m may be listed, too.
        int upwards = 0;
        for (const PointPair& p : found) {
          const Vector3d normal = at.linear().transpose() * p.normal;
          INFO("normal " << normal.transpose() << " gap " << p.gap_m << " at " << (at.inverse() * p.on_a_m).transpose());
          CHECK((p.gap_m > 0 || normal.z() > 0.9999));
          if (p.gap_m > 0) continue;
          CHECK(p.gap_m == Approx(-overlap_m).margin(1e-9));
          ++upwards;
        }
        CHECK(upwards >= 3);
      }
}

TEST_CASE("Equal thin plates on each other touch only where they face each other") {
  WorldDef world;
  const Soup plate = box({0.1, 0.1, 5e-4});
  world.meshes.push_back({plate.vertices, {}, plate.indices});
  ShapeDef mesh;
  mesh.kind = ShapeKind::kMesh, mesh.mesh = 0, mesh.size_m = {1, 1, 1};
  const auto detector = make_detector("gaps");
  const int lower = detector->add(mesh, world), upper = detector->add(mesh, world);
  std::vector<PointPair> found;
  for (const double gap_m : {0.0, 1e-7, 1e-5}) {
    detector->query(lower, Isometry3d::Identity(), upper, Isometry3d(Eigen::Translation3d(0, 0, 5e-4 + gap_m)), 2e-3, found);
    REQUIRE_FALSE(found.empty());
    for (const PointPair& p : found) CHECK(p.gap_m > gap_m - 4e-6);
  }
}
