// Mesh against mesh, compared with FCL and on third-party models.
#include <filesystem>

#include "sim_node/collision/detector.h"
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

#ifdef TACTUS_WITH_FCL
namespace {

// The number of poses, from nearly touching to far apart.
void check_distances(const std::string& name, const Soup& sa, const Soup& sb, int poses, Random& random) {
  const ContactMesh a(sa.vertices, sa.indices), b(sb.vertices, sb.indices);
  WorldDef world;
  world.meshes = {{sa.vertices, {}, sa.indices}, {sb.vertices, {}, sb.indices}};
  auto fcl = make_fcl_detector();
  ShapeDef shape;
  shape.kind = ShapeKind::kMesh;
  for (shape.mesh = 0; shape.mesh < 2; ++shape.mesh) fcl->add(shape, world);
  MeshContact contact;
  for (int i = 0; i < poses; ++i) {
    Isometry3d pose = random_pose(random, 1);
    pose.translation() = uniform(random, 0.5, 2.5) * kRadius_m * direction(random);
    std::vector<PointPair> found;
    fcl->query(0, Isometry3d::Identity(), 1, pose, 1, found);
    const double ours = contact.distance_m(a, Isometry3d::Identity(), b, pose, 1);
    const double theirs = found.empty() ? 0 : std::max(0.0, found[0].gap_m);
    INFO(name << ", pose " << i << ", ours " << ours << ", FCL's " << theirs);
    CHECK(std::abs(ours - theirs) < 1e-9);
  }
}

}  // namespace

TEST_CASE("The least distance of two meshes equals FCL's") {
  Random random(12);
  check_distances("lumpy spheres", lumpy_sphere(4, kRadius_m, 1), lumpy_sphere(4, kRadius_m, 2), 30, random);
  check_distances("comb and sphere", comb(5, kRadius_m), lumpy_sphere(3, kRadius_m, 3), 30, random);
  check_distances("combs", comb(5, kRadius_m), comb(4, kRadius_m), 30, random);
  check_distances("plates", plate(kRadius_m, kRadius_m, 7, 5), plate(kRadius_m, 0.5 * kRadius_m, 3, 9), 30,
                  random);
  check_distances("slivers", slivers(80, kRadius_m, 3), slivers(80, kRadius_m, 4), 30, random);
  check_distances("degenerate", with_degenerate(comb(3, kRadius_m)), lumpy_sphere(2, kRadius_m, 5), 30, random);
  check_distances("T-junctions and doubled", t_junctions(kRadius_m), doubled_and_reversed(comb(3, kRadius_m)), 30,
                  random);
}

TEST_CASE("The least distance of models equals FCL's") {
  if (!models_are_there()) return;
  Random random(13);
  for (const char* name : kNames) {
    const Soup soup = model(kModels / name);
    check_distances(name, soup, lumpy_sphere(3, kRadius_m, 3), 12, random);
    check_distances(std::string(name) + " twice", soup, soup, 8, random);
  }
}
#endif
