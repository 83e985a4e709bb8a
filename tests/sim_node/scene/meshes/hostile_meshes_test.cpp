// Geometry files of a stranger: bombs, cycles, wrong counts, truncation and damage, in every format.
#include <sys/resource.h>

#include <array>
#include <chrono>
#include <cmath>
#include <cstring>
#include <functional>
#include <nlohmann/json.hpp>
#include <random>

#include "sim_node/scene/materials/pictures.h"
#include "sim_node/scene/meshes/confined_reader.h"
#include "sim_node/scene/meshes/gltf_document.h"
#include "sim_node/scene/meshes/gltf_writer.h"
#include "sim_node/scene/meshes/mesh_packing.h"
#include "sim_node/scene/meshes/mesh_reader.h"
#include "tests/grey_png.h"
#include "tests/sim_node/support/scene_file.h"

using namespace tactus;
using namespace tactus::sim;
using Catch::Contains;
using Json = nlohmann::json;

namespace {

std::string why(const std::filesystem::path& file) {
  try {
    read_mesh_parts_confined(file);
    return "";
  } catch (const std::runtime_error& e) {
    return e.what();
  }
}

std::string why_here(const std::filesystem::path& file) {
  try {
    read_mesh_parts(file);
    return "";
  } catch (const std::runtime_error& e) {
    return e.what();
  }
}

// Of the readers so far, which are waited for; the largest of them.
double memory_of_readers_MB() {
  rusage usage{};
  getrusage(RUSAGE_CHILDREN, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

// Sanitizers add space around every block of memory and keep freed blocks.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr double kReaders_MB = 3 * 1200;
#else
constexpr double kReaders_MB = 1200;
#endif

MeshParts square() {
  MeshParts mesh;
  MeshPart part;
  part.positions_m = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}};
  part.normals.assign(4, {0, 0, 1});
  part.texcoords = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  part.indices = {0, 1, 2, 0, 2, 3};
  mesh.parts.push_back(part);
  return mesh;
}

Json gltf() {
  const sync::Bytes bytes = write_gltf(square(), false);
  return Json::parse(bytes.begin(), bytes.end());
}

std::string text_of(const sync::Bytes& bytes) { return {bytes.begin(), bytes.end()}; }

std::string collada(const std::string& nodes, const std::string& scene) {
  return R"(<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><asset><unit
 meter="1"/><up_axis>Z_UP</up_axis></asset><library_geometries><geometry id="g" name="g"><mesh><source id="p"><float_array
 id="a" count="9">0 0 0 1 0 0 0 1 0</float_array><technique_common><accessor source="#a" count="3" stride="3"><param name="X"
 type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source><vertices
 id="v"><input semantic="POSITION" source="#p"/></vertices><triangles count="1"><input semantic="VERTEX" source="#v"
 offset="0"/><p>0 1 2</p></triangles></mesh></geometry></library_geometries><library_nodes>)" +
         nodes + "</library_nodes><library_visual_scenes><visual_scene id=\"s\">\n" + scene +
         "</visual_scene></library_visual_scenes><scene><instance_visual_scene url=\"#s\"/></scene></COLLADA>";
}

std::string numbers(auto... values) {
  std::string s;
  (s.append(reinterpret_cast<const char*>(&values), sizeof values), ...);
  return s;
}

std::string binary_stl(std::uint32_t declared) {
  std::string s(80, ' ');
  return s + numbers(declared, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f, std::uint16_t{0});
}

// A small valid file of every format that users have, by its name.
std::vector<std::pair<std::string, std::string>> valid_files() {
  const auto chunk = [](std::uint16_t number, const std::string& inside) {
    return numbers(number, static_cast<std::uint32_t>(inside.size() + 6)) + inside;
  };
  const std::uint16_t n3 = 3, n1 = 1, i0 = 0, i1 = 1, i2 = 2, flags = 7;
  const std::string points = chunk(0x4110, numbers(n3, 0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f));
  const std::string faces = chunk(0x4120, numbers(n1, i0, i1, i2, flags));
  const std::string object = chunk(0x4000, std::string("part\0", 5) + chunk(0x4100, points + faces));
  return {{"t.obj", "mtllib t.mtl\nusemtl a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\nf 1/1/1 2/1/1 3/1/1\n"},
          {"t.stl", binary_stl(1)},
          {"a.stl", "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid s\n"},
          {"t.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
                    "property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"},
          {"t.dae", collada("", "<node id=\"n\"><instance_geometry url=\"#g\"/></node>")},
          {"t.3ds", chunk(0x4D4D, chunk(0x3D3D, object))},
          {"t.gltf", text_of(write_gltf(square(), false))},
          {"t.glb", text_of(write_gltf(square(), true))}};
}

}  // namespace

TEST_CASE("The confined reader returns the same bits as the reader in this process") {
  SceneFile file;
  for (const auto& [name, text] : valid_files()) {
    CAPTURE(name);
    file.write(name, text);
    file.write("t.mtl", "newmtl a\nKd 0.5 0.25 1\nNs 77\nmap_Kd c.png\n");
    CHECK(pack(read_mesh_parts_confined(file.folder() / name)) == pack(read_mesh_parts(file.folder() / name)));
  }
}

TEST_CASE("A packed mesh that is cut off at any byte is rejected") {
  MeshParts mesh = square();
  mesh.materials.resize(2);
  mesh.materials[1].colour_map.bytes = {1, 2, 3};
  mesh.materials[1].normal_map.file = "n.png";
  mesh.material["base"] = "oak";
  const auto whole = pack(mesh);
  CHECK(pack(unpack_mesh(whole)) == whole);
  for (std::size_t size = 0; size < whole.size(); ++size)
    CHECK_THROWS_AS(unpack_mesh(std::span(whole).first(size)), std::runtime_error);
  // A reader under the control of a file may return any bytes: they are rejected, or a mesh whose indices exist.
  std::mt19937 random(7);
  for (int i = 0; i < 20'000; ++i) {
    auto changed = whole;
    for (int k = 0; k < 1 + i % 4; ++k) changed[random() % changed.size()] = static_cast<std::uint8_t>(random());
    try {
      MeshParts read = unpack_mesh(changed);
      check_mesh_parts(read);
      for (const MeshPart& part : read.parts)
        for (const int index : part.indices)
          REQUIRE((index >= 0 && static_cast<std::size_t>(index) < part.positions_m.size()));
    } catch (const std::runtime_error& e) {
      REQUIRE(std::strlen(e.what()) > 0);
    }
  }
}

TEST_CASE("A glTF of some kilobytes that uses accessors, nodes or pictures many times is counted before it is read") {
  SceneFile file;
  const auto said = [&](auto change) {
    Json document = gltf();
    change(document);
    file.write("t.gltf", document.dump());
    return why(file.folder() / "t.gltf");
  };
  // Accessors without a buffer have any count of zeros.
  CHECK_THAT(said([](Json& d) {
               for (Json& a : d["accessors"]) a.erase("bufferView"), a["count"] = 3'000'000;
               const Json primitive = d["meshes"][0]["primitives"][0];
               for (int i = 0; i < 300; ++i) d["meshes"][0]["primitives"].push_back(primitive);
             }),
             Contains("more than 3000000 vertices") || Contains("more than 1000000 triangles"));
  CHECK_THAT(said([](Json& d) {
               const Json primitive = d["meshes"][0]["primitives"][0], node = d["nodes"][0];
               for (int i = 0; i < 999; ++i) d["meshes"][0]["primitives"].push_back(primitive);
               for (int i = 1; i < 2000; ++i) d["nodes"].push_back(node), d["scenes"][0]["nodes"].push_back(i);
             }),
             Contains("more than 1000000 triangles") || Contains("parts") || Contains("vertices"));
  CHECK_THAT(said([](Json& d) {
               for (int i = 0; i < 999; ++i) d["meshes"][0]["primitives"].push_back({{"attributes", Json::object()}});
               for (int i = 1; i < 2000; ++i) d["nodes"].push_back(d["nodes"][0]), d["scenes"][0]["nodes"].push_back(i);
             }),
             Contains("more than 100000 parts"));
  // One picture of 1 MB in each of a thousand materials.
  CHECK_THAT(said([](Json& d) {
               d["images"] = {{{"uri", "data:image/png;base64," + std::string(1 << 20, 'A')}}};
               d["textures"] = {{{"source", 0}}};
               for (int i = 0; i < 1000; ++i)
                 d["materials"].push_back({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
             }),
             Contains("pictures are larger than 256 MiB"));
  CHECK_THAT(said([](Json& d) {
               for (int i = 0; i < 1000; ++i) d["nodes"].push_back({{"children", {i}}});
               d["scenes"][0]["nodes"] = {1000};
             }),
             Contains("too deep"));
  CHECK(memory_of_readers_MB() < kReaders_MB);
}

TEST_CASE("A COLLADA file whose nodes use each other is counted before assimp expands it") {
  SceneFile file;
  std::string nodes;
  for (int i = 0; i < 40; ++i) {
    const std::string next = "<instance_node url=\"#n" + std::to_string(i + 1) + "\"/>";
    nodes += "<node id=\"n" + std::to_string(i) + "\">" + next + next + "</node>";
  }
  nodes += "<node id=\"n40\"><instance_geometry url=\"#g\"/></node>";
  const std::string use = "<node id=\"top\"><instance_node url=\"#n0\"/></node>";
  file.write("t.dae", collada(nodes, use));
  CHECK_THAT(why(file.folder() / "t.dae"), Catch::StartsWith("line ") && Contains("its nodes expand to more than 100000"));
  // The same with names instead of ids.
  std::string named = nodes;
  for (auto at = named.find("node id="); at != std::string::npos; at = named.find("node id=")) named.replace(at, 8, "node name=");
  file.write("t.dae", collada(named, use));
  CHECK_THAT(why(file.folder() / "t.dae"), Contains("its nodes expand to more than 100000"));
  file.write("t.dae", collada("<node id=\"n0\"><instance_node url=\"#n1\"/></node><node id=\"n1\"><instance_node url=\"#n0\"/></node>", use));
  CHECK_THAT(why(file.folder() / "t.dae"), Contains("this node contains itself"));
  std::string chain;
  for (int i = 0; i < 3000; ++i)
    chain += "<node id=\"n" + std::to_string(i) + "\"><instance_node url=\"#n" + std::to_string(i + 1) + "\"/></node>";
  file.write("t.dae", collada(chain, use));
  CHECK_THAT(why(file.folder() / "t.dae"), Contains("nested deeper than 100 levels"));
  std::string deep;
  for (int i = 0; i < 100'000; ++i) deep += "<node>";
  file.write("t.dae", collada("", deep));
  CHECK_THAT(why(file.folder() / "t.dae"), Contains("nested too deeply"));
  CHECK(memory_of_readers_MB() < kReaders_MB);
}

TEST_CASE("Counts in files that are negative, huge or wrong are one clause and little memory") {
  SceneFile file;
  const auto said = [&](const std::string& name, const std::string& text) {
    file.write(name, text);
    const std::string clause = why(file.folder() / name);
    INFO(name << ": " << clause);
    CHECK(clause.find('\n') == std::string::npos);
    return clause;
  };
  for (const std::uint32_t count : {2u, 1'000'000u, 0x7fffffffu, 0x80000000u, 0xffffffffu}) CHECK(said("t.stl", binary_stl(count)) != "");
  const auto ply = [](const std::string& count, const std::string& comment = "") {
    return "ply\nformat ascii 1.0\n" + comment + "element vertex " + count + "\nproperty float x\nproperty float y\nproperty float z\n" +
           "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  };
  const std::string long_line = "comment " + std::string(1000, 'x') + "\n";
  std::string many_lines;
  for (int i = 0; i < 2000; ++i) many_lines += "comment\n";
  for (const std::string count : {"4000000000", "-1", "1e99999", "0x99", "x"})
    for (const std::string& comment : {std::string(), long_line, many_lines}) CHECK(said("t.ply", ply(count, comment)) != "");
  CHECK_THAT(said("t.ply", ply("3", std::string(70'000, ' ') + "\n")), Contains("header has no end"));
  for (const std::string index : {"4", "-9", "2147483647", "99999999999999999999"})
    said("t.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 " + index + "\n");
  for (const std::string number : {"nan", "inf", "-inf", "1e40", "1e999"})
    CHECK(said("t.obj", "v 0 0 " + number + "\nv 1 0 0\nv 0 1 0\nf 1 2 3\n") != "");
  CHECK(memory_of_readers_MB() < kReaders_MB);
}

TEST_CASE("A glTF whose sizes, offsets or indices are no numbers, or contradict each other, is refused, not read in part") {
  SceneFile file;
  const auto why_with = [&](const std::function<void(Json&)>& change) {
    Json document = gltf();
    change(document);
    file.write("mesh.gltf", document.dump());
    return why_here(file.folder() / "mesh.gltf");
  };
  CHECK(why_with([](Json&) {}) == "");
  const std::size_t bytes = gltf()["buffers"][0]["byteLength"];
  CHECK_THAT(why_with([&](Json& f) { f["buffers"][0]["byteLength"] = bytes - 1; }), Contains("beyond its buffer"));
  CHECK_THAT(why_with([&](Json& f) { f["buffers"][0]["byteLength"] = bytes + 1; }), Contains("shorter than its byteLength"));
  for (const Json& bad : {Json(-1), Json(1.5), Json("x"), Json(1e12)}) {
    INFO(bad);
    CHECK(why_with([&](Json& f) { f["meshes"][0]["primitives"][0]["indices"] = bad; }) != "");
    CHECK(why_with([&](Json& f) { f["buffers"][0]["byteLength"] = bad; }) != "");
    CHECK(why_with([&](Json& f) { f["bufferViews"][0]["byteOffset"] = bad; }) != "");
    CHECK(why_with([&](Json& f) { f["bufferViews"][0]["byteStride"] = bad; }) != "");
    CHECK(why_with([&](Json& f) { f["accessors"][0]["byteOffset"] = bad; }) != "");
    CHECK(why_with([&](Json& f) { f["accessors"][0]["bufferView"] = bad; }) != "");
  }
  const int indices = gltf()["meshes"][0]["primitives"][0]["indices"];
  CHECK_THAT(why_with([&](Json& f) { f["accessors"][static_cast<std::size_t>(indices)]["count"] = 5; }), Contains("three corners"));
  CHECK_THAT(why_with([](Json& f) { f["nodes"][0]["scale"] = {1, 2}; }), Contains("the scale of a node is not 3 numbers"));
}

TEST_CASE("A mesh with a million triangles around one point has its normals in linear time") {
  // A plain mean for each of 3 million corners, summed over a million triangles each time, would take an hour.
  MeshParts mesh;
  MeshPart part;
  part.positions_m = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  for (int i = 0; i < 200'000; ++i) part.indices.insert(part.indices.end(), {0, 1, 2});
  mesh.parts.push_back(part);
  Json document;
  const sync::Bytes bytes = write_gltf(mesh, false);
  SceneFile file;
  file.write("t.gltf", text_of(bytes));
  const MeshPart read = read_mesh_parts(file.folder() / "t.gltf").parts.at(0);
  CHECK(read.indices.size() == 600'000);
  CHECK(read.normals.at(0) == Eigen::Vector3f(0, 0, 1));
}

TEST_CASE("A geometry file that is cut off is a mesh or one clause") {
  SceneFile file;
  for (const auto& [name, whole] : valid_files()) {
    CAPTURE(name);
    const bool own = name.starts_with("t.gl");  // our reader: in this process
    const std::size_t step = own ? 3 : std::max<std::size_t>(1, whole.size() / 12);
    for (std::size_t size = 0; size < whole.size(); size += step) {
      file.write(name, whole.substr(0, size));
      const std::string clause = own ? why_here(file.folder() / name) : why(file.folder() / name);
      INFO(size << ": " << clause);
      CHECK(clause.find('\n') == std::string::npos);
      if (own) CHECK(clause != "");
    }
  }
}

TEST_CASE("A damaged geometry file is a mesh or one clause, and its reader stays within its memory") {
  SceneFile file;
  std::mt19937 random(23);
  const std::array<std::string, 8> pieces{"-1", "4294967295", "1e38", "nan", "\xff\xff\xff\xff", std::string(4, '\0'), "\x7f\xff\xff\xff", "99999999999"};
  for (const auto& [name, whole] : valid_files()) {
    CAPTURE(name);
    const bool own = name.starts_with("t.gl");
    for (int i = 0; i < (own ? 500 : 12); ++i) {
      std::string changed = whole;
      for (int k = 0; k < 1 + i % 4; ++k) {
        const std::size_t at = random() % changed.size();
        const std::string& piece = pieces[random() % pieces.size()];
        if (random() % 2 == 0)
          changed[at] = static_cast<char>(random());
        else
          changed.replace(at, std::min(piece.size(), changed.size() - at), piece);
      }
      file.write(name, changed);
      const std::string clause = own ? why_here(file.folder() / name) : why(file.folder() / name);
      INFO(i << ": " << clause);
      CHECK(clause.find('\n') == std::string::npos);
    }
  }
  CHECK(memory_of_readers_MB() < kReaders_MB);
}

TEST_CASE("A picture that is cut off at any byte or damaged is accepted or one clause") {
  const std::vector<std::uint8_t> whole = tactus::test::png_bytes(3, 2, 8, {0, 1, 2, 3, 4, 5});
  CHECK_NOTHROW(check_picture(whole, PictureUse::kColour));
  for (std::size_t size = 0; size < whole.size(); ++size)
    CHECK_THROWS_AS(check_picture(std::span(whole).first(size), PictureUse::kColour), std::runtime_error);
  std::mt19937 random(2);
  for (int i = 0; i < 20'000; ++i) {
    auto changed = whole;
    if (i % 2 == 0) changed = {0xff, 0xd8, 0xff, 0xc0, 0, 17, 8, 0, 2, 0, 3, 3, 0, 0, 0, 0, 0};
    for (int k = 0; k < 1 + i % 4; ++k) changed[random() % changed.size()] = static_cast<std::uint8_t>(random());
    try {
      check_picture(changed, PictureUse::kColour);
    } catch (const std::runtime_error& e) {
      REQUIRE(std::strlen(e.what()) > 0);
    }
  }
}

TEST_CASE("A geometry file without a surface is refused with a sentence that names the lack") {
  SceneFile file;
  const char* points = "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\nend_header\n0 0 0\n";
  for (const auto& [name, text] : {std::pair{"lines.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nl 1 2\np 3\n"}, {"points.obj", "v 0 0 0\nv 1 0 0\n"},
                                   {"empty.stl", "solid a\nendsolid a\n"}, {"points.ply", points}}) {
    INFO(name);
    file.write(name, text);
    CHECK_THAT(why_here(file.folder() / name), Contains("it holds no surface, neither a triangle nor a polygon; export it with faces"));
  }
}
