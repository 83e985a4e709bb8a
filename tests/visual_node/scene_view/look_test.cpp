#include "visual_node/scene_view/look.h"

#include <catch2/catch.hpp>
#include <tactus/look_t.hpp>
#include <tactus/mesh_t.hpp>
#include <tactus/scene_t.hpp>
#include <tactus/shader_t.hpp>
#include <tactus/shape_def_t.hpp>

#include "tests/visual_node/support/test_scene.h"
#include "visual_node/scene_view/scene_view.h"

using namespace tactus;
using namespace tactus::visual;

namespace {
look_t look(const std::string& name, const std::string& shader, std::int64_t colour = 0, std::int64_t normal = 0,
            float reflectance = 0) {
  look_t l{};
  l.name = name, l.shader = shader, l.colour_map = colour, l.normal_map = normal, l.reflectance = reflectance;
  return l;
}
sync::Raster dot(bool translucent) {
  return {1, 1, translucent, {1, 2, 3, static_cast<std::uint8_t>(translucent ? 4 : 255)}};
}
}  // namespace

TEST_CASE("Look i of a scene has index i + 1, and index 0 is plain Phong") {
  scene_t scene = test::empty_scene();
  scene.looks = {look("a", ""), look("b", "gouraud", 5), look("c", "normal_mapped", 5, 6), look("d", "phong", 7)};
  scene.environment_asset = 6;
  const Appearance made = make_appearance(scene, {{{5, dot(false)}, {6, dot(true)}}, {}});
  REQUIRE(made.looks.size() == 5);
  CHECK(made.looks[0].shader == "phong");
  CHECK_FALSE(made.looks[0].mapped());
  CHECK(made.looks[1].shader == "phong");
  CHECK(made.looks[2].shader == "gouraud");
  // A picture is stored once, also if several looks use it.
  CHECK(made.pictures.size() == 2);
  CHECK(made.looks[2].colour_map == made.looks[3].colour_map);
  CHECK(made.environment == made.looks[3].normal_map);
  // A missing picture is left out.
  CHECK(made.looks[4].colour_map == -1);
  // Only the opacity of colour maps counts.
  for (const Look& l : made.looks) CHECK_FALSE(l.translucent);
}

TEST_CASE("A look has its reflectance, and a mirror without one has that of glass") {
  scene_t scene = test::empty_scene();
  scene.looks = {look("a", "reflecting"), look("b", "reflecting", 0, 0, 0.5f), look("c", "phong", 0, 0, 0.2f),
                 look("d", "phong")};
  const Appearance made = make_appearance(scene, {});
  // ((n - 1) / (n + 1))^2 for n = 1.5.
  CHECK(made.looks[1].reflectance == Approx(0.04f));
  CHECK(made.looks[2].reflectance == 0.5f);
  CHECK(made.looks[3].reflectance == 0.2f);
  CHECK(made.looks[4].reflectance == 0);
}

TEST_CASE("A surface with a translucent picture is drawn after opaque ones") {
  scene_t scene = test::empty_scene();
  for (int i = 0; i < 2; ++i) {
    test::add_visual(scene, test::add_body(scene, {2, 0, 0}), shape_def_t::BOX, {0.1, 0.1, 0.1});
    scene.visuals.back().look = i;
  }
  scene.looks = {look("leaf", "textured", 5), look("wall", "textured", 6)};
  const SceneView view(scene, {}, Settings{}, {}, {{{5, dot(true)}, {6, dot(false)}}, {}});
  const std::vector<Eigen::Isometry3d> poses(2, Eigen::Isometry3d::Identity());
  const DrawList list = view.draw(poses, {});
  REQUIRE(list.translucent.size() == 1);
  CHECK(list.translucent[0].look == 1);
  REQUIRE(list.opaque.size() == 1);
  CHECK(list.opaque[0].look == 2);
}

TEST_CASE("Shaders and passes of a scene have their sources and names, and a missing source is empty") {
  scene_t scene = test::empty_scene();
  shader_t shader{};
  shader.name = "stripes", shader.fragment_asset = 8, shader.vertex_asset = 9, shader.fragment_file = "s.frag";
  scene.shaders = {shader};
  scene.passes.emplace_back().shader = "greyscale";
  const Appearance made = make_appearance(scene, {{}, {{8, "text"}}});
  REQUIRE(made.shaders.size() == 1);
  CHECK(made.shaders[0].fragment == "text");
  CHECK(made.shaders[0].fragment_file == "s.frag");
  CHECK(made.shaders[0].vertex.empty());
  REQUIRE(made.passes.size() == 1);
  CHECK(made.passes[0].shader == "greyscale");
}

TEST_CASE("A look index out of range is drawn without a look") {
  scene_t scene = test::empty_scene();
  test::add_visual(scene, test::add_body(scene, {2, 0, 0}), shape_def_t::BOX, {0.1, 0.1, 0.1});
  scene.visuals[0].look = GENERATE(-1, -7, 0, 3, 2147483647);
  const SceneView view(scene, {}, Settings{});
  const std::vector<Eigen::Isometry3d> poses(1, Eigen::Isometry3d::Identity());
  CHECK(view.draw(poses, {}).opaque.at(0).look == 0);
}

TEST_CASE("A picture on a mesh without texture coordinates is reported") {
  scene_t scene = test::empty_scene();
  test::add_visual(scene, test::add_body(scene, {2, 0, 0}), shape_def_t::MESH, {1, 1, 1});
  scene.visuals[0].shape.mesh_hash = 3, scene.visuals[0].shape.name = "kettle", scene.visuals[0].look = 0;
  scene.looks = {look("tiles", "normal_mapped", 5, 6)};
  mesh_t mesh{};
  mesh.positions_m = {0, 0, 0, 1, 0, 0, 0, 1, 0}, mesh.normals = {0, 0, 1, 0, 0, 1, 0, 0, 1},
  mesh.indices = {0, 1, 2};
  const LookFiles files{{{5, dot(false)}, {6, dot(false)}}, {}};
  const auto warnings = [&] { return SceneView(scene, {{3, mesh}}, Settings{}, {}, files).warnings(); };
  REQUIRE(warnings().size() == 1);
  CHECK_THAT(warnings()[0],
             Catch::Contains("tiles") && Catch::Contains("kettle") && Catch::Contains("no texture coordinates"));
  mesh.texcoords = {0, 0, 1, 0, 0, 1};
  REQUIRE(warnings().size() == 1);
  CHECK_THAT(warnings()[0], Catch::Contains("tangents"));
  mesh.tangents = {1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1};
  CHECK(warnings().empty());
}
