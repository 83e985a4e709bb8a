#include "sim_node/scene/scene_assets.h"

#include <set>
#include <tactus/asset_ref_t.hpp>
#include <tactus/mesh_t.hpp>
#include <tactus/scene_t.hpp>
#include <tactus/shape_def_t.hpp>

#include "lcmtypes/vectors.h"
#include "tests/sim_node/support/scene_file.h"
#include "sync/bus/decode.h"
#include "sync/bus/identity.h"
#include "tests/source_dir.h"

using namespace tactus;
using namespace tactus::sim;

namespace {
WorldDef dark_room(std::vector<std::string>& warnings) {
  return load_sdf(source_dir() + "/sim_node/scenes/dark_room.sdf", warnings);
}
}  // namespace

TEST_CASE("The assets of a world decode to their sources") {
  std::vector<std::string> warnings;
  WorldDef w = dark_room(warnings);
  Heightfield h;
  h.columns = h.rows = 3, h.size_m = {1, 1, 1}, h.heights_m.assign(9, 0.5);
  w.heightfields.push_back(h);
  ShapeDef ground;
  ground.kind = ShapeKind::kHeightfield, ground.mesh = 0, ground.body = 0;
  w.shapes.push_back(ground);

  const auto assets = make_assets(w);
  REQUIRE(assets.size() == 1 + w.meshes.size() + 1 + w.images.size() + 1);
  REQUIRE(assets[0].kind == asset_ref_t::SCENE);
  const auto scene = sync::decode_asset<scene_t>(assets[0].bytes);
  REQUIRE(scene);
  CHECK(scene->name == "dark_room");
  CHECK(scene->step_ns == 1'000'000);
  REQUIRE(scene->bodies.size() == w.bodies.size());
  for (std::size_t i = 0; i < w.bodies.size(); ++i) {
    CHECK(scene->bodies[i].id == static_cast<int>(i));
    CHECK(scene->bodies[i].name == w.bodies[i].name);
    CHECK(to_eigen(scene->bodies[i].pose).isApprox(w.bodies[i].pose, 1e-9));
    CHECK((scene->bodies[i].mass_kg == 0) == w.bodies[i].is_static);
  }
  CHECK(scene->visuals.size() == w.visuals.size());
  CHECK(scene->tools.size() == 2);
  CHECK(scene->tools[0].waypoints.size() == w.tools[0].waypoints.size());
  CHECK(scene->materials.size() == w.materials.size());
  CHECK(scene->lights.size() == w.lights.size());

  std::set<std::int64_t> hashes;
  for (const auto& asset : assets) {
    if (asset.kind != asset_ref_t::MESH) continue;
    const auto mesh = sync::decode_asset<mesh_t>(asset.bytes);
    REQUIRE(mesh);
    CHECK(mesh->positions_m.size() == mesh->normals.size());
    for (int index : mesh->indices) CHECK(index * 3 + 2 < mesh->vertex_floats);
    hashes.insert(sync::fnv1a_64(asset.bytes.data(), asset.bytes.size()));
  }
  int meshes = 0;
  for (const shape_def_t& shape : scene->shapes) {
    if (shape.kind != shape_def_t::MESH) continue;
    ++meshes;
    CHECK(hashes.contains(shape.mesh_hash));
  }
  CHECK(meshes == 2);
  CHECK(assets.back().kind == asset_ref_t::SDF);
  CHECK(std::string(assets.back().bytes.begin(), assets.back().bytes.end()) == w.source_text);
}

TEST_CASE("The same world has identical assets, so that renderers do not reload after a restart") {
  std::vector<std::string> warnings;
  const auto a = make_assets(dark_room(warnings)), b = make_assets(dark_room(warnings));
  REQUIRE(a.size() == b.size());
  for (std::size_t i = 0; i < a.size(); ++i) CHECK(a[i].bytes == b[i].bytes);
}
