// Mesh against mesh, on third-party models.
#include <filesystem>

#include "sim_node/scene/meshes/mesh_file.h"
#include "tests/sim_node/support/contact_check.h"

using namespace tactus::sim;
using namespace tactus::sim::test;
using Eigen::Isometry3d;
using Eigen::Vector3d;

namespace {

constexpr double kRadius_m = 0.1;

// Scaled to a radius of 0.1 m about the origin.
Soup model(const std::filesystem::path& file) {
  TriangleMesh m = read_mesh(file, "", true, {1, 1, 1});
  double largest = 0;
  for (const Vector3d& v : m.vertices) largest = std::max(largest, v.norm());
  for (Vector3d& v : m.vertices) v *= kRadius_m / largest;
  return {m.vertices, m.indices};
}

const std::filesystem::path kModels = "/usr/share/assimp/models";
constexpr const char* kNames[] = {"OBJ/spider.obj",   "OFF/Wuson.off", "PLY/Wuson.ply",
                                  "Collada/duck.dae", "OBJ/box.obj",   "3DS/fels.3ds"};

bool models_are_there() {
  if (std::filesystem::exists(kModels)) return true;
  WARN("the package assimp-testmodels is not installed: its models are not tested; scripts/setup installs it");
  return false;
}

}  // namespace

TEST_CASE("Every near pair of triangles of the assimp models is covered without false pairs") {
  if (!models_are_there()) return;
  const auto other = lumpy_sphere(2, kRadius_m, 3);
  for (const char* name : kNames) {
    const Soup soup = model(kModels / name);
    const ContactMesh a(soup.vertices, soup.indices);
    Random random(4);
    int near = 0;
    for (int i = 0; i < 2; ++i) {
      const Soup& second = i % 2 ? soup : other;
      const ContactMesh b(second.vertices, second.indices);
      const Isometry3d pose = placed_near(a, b, random, 3 * kRadius_m, 5e-4);
      const double tolerance = 1e-3;
      MeshContact contact;
      MeshContactResult found;
      contact.query(a, Isometry3d::Identity(), b, pose, {tolerance, tolerance / 2}, found);
      INFO(name << ", " << soup.triangles() << " triangles, pose " << i << ", " << found.pairs.size() << " pairs");
      const Placed pa(soup, Isometry3d::Identity()), pb(second, pose);
      const Truth truth = compare(pa, pb, tolerance, found);
      CHECK(truth.missed == 0);
      check_sound(pa, pb, tolerance, found);
      near += truth.near;
    }
    INFO(name << ": " << near << " pairs of triangles near");
    CHECK(near > 0);
  }
}

TEST_CASE("The contact of models does not depend on mesh order, frame, winding or triangle order") {
  if (!models_are_there()) return;
  const auto other = lumpy_sphere(2, kRadius_m, 3);
  for (const char* name : kNames) {
    const Soup soup = model(kModels / name);
    const ContactMesh a(soup.vertices, soup.indices), b(other.vertices, other.indices);
    Random random(6);
    int compared = 0;
    for (int i = 0; i < 3; ++i) {
      INFO(name << ", pose " << i);
      const Isometry3d pose = placed_near(a, b, random, 3 * kRadius_m, 5e-4);
      compared += check_invariant(soup, other, pose, {1e-3, 5e-4}, random);
    }
    INFO(name << ": " << compared << " pairs");
    CHECK(compared > 0);
  }
}
