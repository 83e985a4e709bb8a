// Conversion of any file to glTF and back: identical to the bit, and a scene that loads it uses its properties.
#include "sim_node/scene/meshes/convert_geometry.h"

#include <bit>
#include <cstring>
#include <random>
#include <tactus/material_def_t.hpp>

#include "tests/sim_node/support/scene_file.h"
#include "sim_node/scene/meshes/gltf_writer.h"
#include "sim_node/scene/meshes/mesh_reader.h"
#include "sim_node/scene/scene_assets.h"
#include "tests/grey_png.h"
#include "tests/source_dir.h"

using namespace tactus;
using namespace tactus::sim;

namespace {

template <typename List>
bool same_bits(const List& a, const List& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof a[0]) == 0);
}

// Stricter than the check of the program: 0 and -0 differ.
void check_same(const MeshParts& a, const MeshParts& b) {
  REQUIRE(a.parts.size() == b.parts.size());
  for (std::size_t i = 0; i < a.parts.size(); ++i) {
    const MeshPart &x = a.parts[i], &y = b.parts[i];
    CHECK(x.mesh == y.mesh);
    CHECK(x.node == y.node);
    CHECK(x.material == y.material);
    CHECK(same_bits(x.positions_m, y.positions_m));
    CHECK(same_bits(x.normals, y.normals));
    CHECK(same_bits(x.tangents, y.tangents));
    CHECK(same_bits(x.texcoords, y.texcoords));
    CHECK(x.indices == y.indices);
  }
  CHECK(a.materials == b.materials);
  CHECK(a.material == b.material);
  CHECK(a.look == b.look);
}

MeshParts read_back(const SceneFile& file, const MeshParts& mesh, bool packed) {
  const std::string name = packed ? "back.glb" : "back.gltf";
  const sync::Bytes bytes = write_gltf(mesh, packed);
  file.write(name, {bytes.begin(), bytes.end()});
  return read_mesh_parts(file.folder() / name);
}

MeshParts random_mesh(std::mt19937& random) {
  const auto number = [&](float low, float high) {
    return std::uniform_real_distribution<float>(low, high)(random);
  };
  const auto count = [&](int low, int high) { return std::uniform_int_distribution<int>(low, high)(random); };
  const auto unit = [&] {
    Eigen::Vector3f n(number(-1, 1), number(-1, 1), number(-1, 1));
    return n.norm() > 0.1f ? Eigen::Vector3f(n.normalized()) : Eigen::Vector3f(0, 0, 1);
  };
  MeshParts mesh;
  for (int m = count(0, 3); m > 0; --m) {
    MeshMaterial material;
    material.name = "m" + std::to_string(m);
    for (Eigen::Vector3f* c : {&material.diffuse, &material.specular, &material.emissive})
      *c = {number(0, 1), number(0, 1), number(0, 1)};
    material.shininess = number(1, 1000);
    material.alpha = count(0, 1) ? 1 : number(0, 1);
    if (count(0, 1)) material.colour_map.file = "maps/a picture %41 \xc3\xa4 " + std::to_string(m) + ".png";
    if (count(0, 1)) material.normal_map.bytes = tactus::test::png_bytes(2, 2, 8, {1, 2, 3, static_cast<std::uint8_t>(m)});
    mesh.materials.push_back(material);
  }
  for (int p = count(1, 4); p > 0; --p) {
    MeshPart part;
    part.mesh = "mesh " + std::to_string(p), part.node = count(0, 1) ? "node" : "";
    part.material = count(-1, static_cast<int>(mesh.materials.size()) - 1);
    const bool textured = count(0, 1), tangents = textured && count(0, 1);
    const int vertices = count(3, 60);
    for (int v = 0; v < vertices; ++v) {
      // All magnitudes, including equal ones, and negative zeros.
      const float size = std::ldexp(1.0f, count(-40, 15));
      part.positions_m.emplace_back(number(-size, size), count(0, 3) ? number(-size, size) : -0.0f, number(-1, 1));
      part.normals.push_back(unit());
      if (textured)
        part.texcoords.emplace_back(number(-3, 3), count(0, 1) ? number(-3, 3) : std::ldexp(1.0f, -count(0, 60)));
      if (tangents) {
        const Eigen::Vector3f t = unit();
        part.tangents.emplace_back(t.x(), t.y(), t.z(), count(0, 1) ? 1.0f : -1.0f);
      }
    }
    for (int t = count(1, 50); t > 0; --t)
      for (int k = 0; k < 3; ++k) part.indices.push_back(count(0, vertices - 1));
    mesh.parts.push_back(part);
  }
  if (count(0, 1)) mesh.material = {{"base", "oak"}, {"bump", "ä ö.png"}, {"bump_size", "1m 2m"}};
  if (count(0, 1)) mesh.look = {{"shader", "reflecting"}, {"uniforms", "scale 2; \"quoted\" \\ 1"}};
  return mesh;
}

}  // namespace

TEST_CASE("A random mesh written as glTF is read back bit-identically") {
  SceneFile file;
  std::mt19937 random(7);
  for (int i = 0; i < 200; ++i) {
    INFO("mesh " << i);
    const MeshParts mesh = random_mesh(random);
    check_same(read_back(file, mesh, i % 2 == 0), mesh);
  }
}

TEST_CASE("Every mesh of the project is converted to glTF and back bit-identically") {
  SceneFile file;
  int met = 0;
  for (const auto& entry : std::filesystem::directory_iterator(source_dir() + "/sim_node/scenes")) {
    if (entry.path().extension() != ".obj") continue;
    INFO(entry.path());
    ++met;
    const MeshParts mesh = with_output_paths(read_mesh_parts(entry.path()), entry.path(), file.folder() / "back.glb");
    REQUIRE(!mesh.parts.empty());
    for (const MeshPart& part : mesh.parts) CHECK(part.tangents.size() == part.texcoords.size());
    check_same(read_back(file, mesh, true), mesh);
    check_same(read_back(file, mesh, false), mesh);
    // A second conversion changes nothing.
    const auto again = file.folder() / "back.glb";
    check_same(with_output_paths(read_mesh_parts(again), again, again), mesh);
  }
  CHECK(met >= 4);
}

TEST_CASE("Paths of pictures and properties are relative to the new file") {
  SceneFile file;
  std::filesystem::create_directories(file.folder() / "to" / "there");
  MeshParts mesh;
  mesh.materials.emplace_back();
  mesh.materials[0].colour_map.file = "maps/c.png";
  mesh.materials[0].normal_map.file = "/somewhere/n.png";
  mesh.material = {{"base", "oak"}, {"bump", "planks.png"}};
  mesh.look = {{"colour_map", "d.png"}};
  const MeshParts moved =
      with_output_paths(mesh, file.folder() / "from" / "x.obj", file.folder() / "to" / "there" / "x.glb");
  CHECK(moved.materials[0].colour_map.file == "../../from/maps/c.png");
  CHECK(moved.materials[0].normal_map.file == "/somewhere/n.png");
  CHECK(moved.material.at("bump") == "../../from/planks.png");
  CHECK(moved.material.at("base") == "oak");
  CHECK(moved.look.at("colour_map") == "../../from/d.png");
}

TEST_CASE("A material of a scene takes height map, modes and look from the mesh file unless it defines them") {
  const auto picture = tactus::test::png_bytes(2, 2, 8, {0, 10, 20, 30});
  SceneFile file("", {{"planks.png", picture}});
  file.write("box.modes.csv", "frequency_Hz,damping_1_s,amplitude\n440,3,1\n");
  file.write("t.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
  MeshParts mesh = read_mesh_parts(file.folder() / "t.obj");
  mesh.material = {{"base", "oak"},
                   {"bump", "planks.png"},
                   {"bump_size", "0.5m 20cm"},
                   {"bump_height", "1mm"},
                   {"modes", "box.modes.csv"}};
  mesh.look = {{"shader", "reflecting"}, {"reflectance", "0.25"}};
  const auto write = [&] {
    const sync::Bytes bytes = write_gltf(mesh, true);
    file.write("t.glb", {bytes.begin(), bytes.end()});
  };
  write();
  const std::string geometry = "<geometry><mesh><uri>t.glb</uri></mesh></geometry>";
  const auto scene = [&](const std::string& surface, const std::string& look) {
    return link(surface + "<collision name='c'>" + geometry + "</collision><visual name='v'>" + geometry + look +
                "</visual>");
  };
  file.write("scene.sdf", scene("", ""));
  const WorldDef w = file.load();
  CHECK(file.warnings.empty());
  REQUIRE(w.shapes.at(0).material >= 0);
  const material_def_t& m = w.materials[static_cast<std::size_t>(w.shapes[0].material)];
  CHECK(m.name == "t.glb");
  CHECK(m.density_kg_m3 == Approx(700).margin(200));
  CHECK(m.bump_size_v_m == Approx(0.2));
  CHECK(m.bump_asset != 0);
  CHECK(m.modes.at(0).frequency_Hz == 440);
  CHECK(w.shapes[0].friction == m.friction_dynamic);
  CHECK(w.images.size() == 1);
  CHECK(w.visuals.at(0).shape.material == w.shapes[0].material);
  REQUIRE(w.visuals[0].look >= 0);
  CHECK(w.looks[static_cast<std::size_t>(w.visuals[0].look)].shader == "reflecting");
  CHECK(w.looks[static_cast<std::size_t>(w.visuals[0].look)].reflectance == 0.25f);
  SECTION("the scene has precedence for each attribute") {
    file.write("scene.sdf", scene("<tactus:surface material='steel'/>", "<tactus:look reflectance='0.5'/>"));
    const WorldDef own = file.load();
    CHECK(own.materials[static_cast<std::size_t>(own.shapes.at(0).material)].name == "steel");
    CHECK(own.looks.at(static_cast<std::size_t>(own.visuals.at(0).look)).reflectance == 0.5f);
    CHECK(own.looks.at(static_cast<std::size_t>(own.visuals.at(0).look)).shader == "reflecting");
  }
  SECTION("a material name alone refers to the table") {
    mesh.material = {{"base", "copper"}};
    write();
    const WorldDef plain = file.load();
    CHECK(plain.materials[static_cast<std::size_t>(plain.shapes.at(0).material)].name == "copper");
  }
  SECTION("invalid properties are rejected with the name of the file") {
    mesh.material["base"] = "unobtainium";
    write();
    CHECK_THAT(file.load_error(), Catch::Contains("t.glb") && Catch::Contains("no such material"));
    mesh.material["base"] = "oak", mesh.material["bump"] = "gone.png";
    write();
    CHECK_THAT(file.load_error(), Catch::Contains("t.glb") && Catch::Contains("gone.png"));
    mesh.material = {{"base", "unobtainium"}};
    write();
    CHECK_THAT(file.load_error(),
               Catch::Contains("t.glb") && Catch::Contains("there are ") && Catch::Contains("steel"));
    mesh.material.clear(), mesh.look["reflectance"] = "2";
    write();
    CHECK_THAT(file.load_error(), Catch::Contains("t.glb") && Catch::Contains("between 0 and 1"));
  }
}

TEST_CASE("A file is written completely or not at all, without other files") {
  SceneFile file;
  file.write("t.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const MeshParts mesh = read_mesh_parts(file.folder() / "t.obj");
  write_and_verify(mesh, file.folder() / "t.glb");
  write_and_verify(mesh, file.folder() / "t.gltf");
  CHECK_THROWS(write_and_verify(mesh, file.folder() / "none" / "t.glb"));
  CHECK_THROWS_WITH(write_and_verify({}, file.folder() / "empty.glb"), Catch::Contains("no triangle"));
  MeshParts off = mesh;
  off.parts[0].positions_m[0].x() = NAN;
  CHECK_THROWS(write_and_verify(off, file.folder() / "t.glb"));
  check_same(read_mesh_parts(file.folder() / "t.glb"), mesh);
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(file.folder())) files += entry.is_regular_file();
  CHECK(files == 3);
}
