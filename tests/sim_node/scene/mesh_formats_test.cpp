// Content of geometry file formats: the parts that are read, those that are ignored, and files that are rejected.
#include <sys/stat.h>

#include <cstring>
#include <nlohmann/json.hpp>

#include "tests/sim_node/support/scene_file.h"
#include "sim_node/scene/meshes/gltf_document.h"
#include "sim_node/scene/meshes/gltf_writer.h"
#include "sim_node/scene/meshes/mesh_file.h"
#include "sim_node/scene/meshes/mesh_reader.h"
#include "sim_node/scene/meshes/tangents.h"

using namespace tactus;
using namespace tactus::sim;
using Eigen::Vector2f;
using Eigen::Vector3f;
using Eigen::Vector4f;

namespace {

// A square of two triangles with one picture across it, a material and its pictures.
const char* kMtl =
    "newmtl paint\nKd 0.5 0.25 1\nKs 0.1 0.2 0.3\nNs 77\nmap_Kd maps\\colour.png\nnorm ./n.png\nunknown_thing 3\n";
const std::string kObj =
    "mtllib square.mtl\nunknown_statement 1 2 3\nusemtl paint\nv 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nvt 0 0\nvt 1 "
    "0\nvt 1 1\nvt 0 1\n"
    "vn 0 0 1\nf 1/1/1 2/2/1 3/3/1\nf 1/1/1 3/3/1 4/4/1\n";

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

nlohmann::json document_of(const MeshParts& mesh) {
  const sync::Bytes bytes = write_gltf(mesh, false);
  return nlohmann::json::parse(bytes.begin(), bytes.end());
}

std::string why(const std::filesystem::path& file) {
  try {
    read_mesh_parts(file);
    return "";
  } catch (const std::exception& e) {
    return e.what();
  }
}

// Ignores the data that a user of the mesh may drop.
bool same_triangles(const MeshParts& a, const MeshParts& b) {
  REQUIRE(a.parts.size() == b.parts.size());
  for (std::size_t i = 0; i < a.parts.size(); ++i)
    if (a.parts[i].positions_m != b.parts[i].positions_m || a.parts[i].indices != b.parts[i].indices ||
        a.parts[i].normals != b.parts[i].normals || a.parts[i].texcoords != b.parts[i].texcoords)
      return false;
  return true;
}

}  // namespace

TEST_CASE(
    "An OBJ's material names its pictures by their place beside the file, and its unknown statements are "
    "ignored") {
  SceneFile file;
  file.write("square.obj", kObj);
  file.write("square.mtl", kMtl);
  const MeshParts mesh = read_mesh_parts(file.folder() / "square.obj");
  REQUIRE(mesh.parts.size() == 1);
  REQUIRE(mesh.parts[0].material >= 0);
  const MeshMaterial& m = mesh.materials[static_cast<std::size_t>(mesh.parts[0].material)];
  CHECK(m.name == "paint");
  CHECK(m.diffuse == Vector3f(0.5f, 0.25f, 1));
  CHECK(m.specular == Vector3f(0.1f, 0.2f, 0.3f));
  CHECK(m.shininess == 77);
  CHECK(m.colour_map.file == "maps/colour.png");
  CHECK(m.normal_map.file == "n.png");
  REQUIRE(mesh.parts[0].texcoords.size() == mesh.parts[0].positions_m.size());
  for (std::size_t i = 0; i < 4; ++i)
    CHECK(mesh.parts[0].texcoords[i] * 2 == mesh.parts[0].positions_m[i].head<2>());
}

TEST_CASE("A mesh file without materials has none") {
  SceneFile file;
  file.write("t.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  file.write("t.stl",
             "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 "
             "0\nendloop\nendfacet\nendsolid s\n");
  for (const char* name : {"t.obj", "t.stl"}) {
    INFO(name);
    const MeshParts mesh = read_mesh_parts(file.folder() / name);
    REQUIRE(mesh.parts.size() == 1);
    CHECK(mesh.parts[0].material == -1);
  }
}

TEST_CASE("Unknown properties of a PLY are ignored") {
  SceneFile file;
  const std::string head =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
  const std::string faces = "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
  file.write("plain.ply", head + faces + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  file.write("more.ply", head + "property float temperature\nproperty uchar smell\n" + faces +
                             "0 0 0 20 1\n1 0 0 21 2\n0 1 0 22 3\n3 0 1 2\n");
  CHECK(same_triangles(read_mesh_parts(file.folder() / "plain.ply"), read_mesh_parts(file.folder() / "more.ply")));
}

TEST_CASE("An unknown element of a DAE is ignored") {
  SceneFile file;
  const auto dae = [](const std::string& extra) {
    return R"(<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><asset><unit
 meter="1"/><up_axis>Z_UP</up_axis></asset>)" +
           extra + R"(<library_geometries><geometry id="g" name="g"><mesh><source id="p"><float_array
 id="a" count="9">0 0 0 1 0 0 0 1 0</float_array><technique_common><accessor source="#a" count="3" stride="3"><param name="X"
 type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source><vertices
 id="v"><input semantic="POSITION" source="#p"/></vertices><triangles count="1"><input semantic="VERTEX" source="#v"
 offset="0"/><p>0 1 2</p></triangles></mesh></geometry></library_geometries><library_visual_scenes><visual_scene id="s"><node
 id="n"><instance_geometry url="#g"/></node></visual_scene></library_visual_scenes><scene><instance_visual_scene url="#s"/></scene>)" +
           extra + "</COLLADA>";
  };
  file.write("plain.dae", dae(""));
  file.write("more.dae", dae("<extra><technique profile=\"smells\"><rose strength=\"3\"/></technique></extra>"));
  CHECK(same_triangles(read_mesh_parts(file.folder() / "plain.dae"), read_mesh_parts(file.folder() / "more.dae")));
}

TEST_CASE("Text after the facets of an STL and unknown chunks of a 3DS are ignored") {
  SceneFile file;
  // Binary STL: 80 arbitrary bytes, a count, then 50 bytes per triangle, the last two of which have no meaning.
  const auto stl = [](char fill, std::uint16_t attribute) {
    std::string s(80, fill);
    const std::uint32_t count = 1;
    const float facet[12] = {0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0};
    s.append(reinterpret_cast<const char*>(&count), 4).append(reinterpret_cast<const char*>(facet), 48);
    return s.append(reinterpret_cast<const char*>(&attribute), 2);
  };
  file.write("plain.stl", stl(' ', 0));
  file.write("more.stl", stl('x', 0x1234));
  CHECK(same_triangles(read_mesh_parts(file.folder() / "plain.stl"), read_mesh_parts(file.folder() / "more.stl")));

  // 3DS: chunks of a number, a length that includes the header, and contents.
  const auto chunk = [](std::uint16_t number, const std::string& inside) {
    const auto length = static_cast<std::uint32_t>(inside.size() + 6);
    std::string s(reinterpret_cast<const char*>(&number), 2);
    return s.append(reinterpret_cast<const char*>(&length), 4) + inside;
  };
  const auto numbers = [](auto... values) {
    std::string s;
    (s.append(reinterpret_cast<const char*>(&values), sizeof values), ...);
    return s;
  };
  const std::uint16_t n3 = 3, n1 = 1, i0 = 0, i1 = 1, i2 = 2, flags = 7;
  const auto ds = [&](const std::string& unknown) {
    const std::string points = chunk(0x4110, numbers(n3, 0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f));
    const std::string faces = chunk(0x4120, numbers(n1, i0, i1, i2, flags));
    const std::string object = chunk(0x4000, std::string("part\0", 5) + chunk(0x4100, points + unknown + faces));
    return chunk(0x4D4D, chunk(0x3D3D, object + unknown) + unknown);
  };
  file.write("plain.3ds", ds(""));
  file.write("more.3ds", ds(chunk(0x7abc, "who knows")));
  const MeshParts plain = read_mesh_parts(file.folder() / "plain.3ds");
  REQUIRE(plain.parts.size() == 1);
  CHECK(plain.parts[0].indices.size() == 3);
  CHECK(same_triangles(plain, read_mesh_parts(file.folder() / "more.3ds")));
}

TEST_CASE("Unknown extras, extensions and attributes of a glTF are ignored") {
  SceneFile file;
  nlohmann::json document = document_of(square());
  file.write("plain.gltf", document.dump());
  document["extras"] = {{"rose", {1, 2, nullptr}}};
  document["extensionsUsed"] = {"VENDOR_smell"};
  document["extensions"]["VENDOR_smell"] = {{"strength", 3}};
  document["nodes"][0]["extras"] = {{"tactus", "no object"}, {"other", 1}};
  document["meshes"][0]["extras"]["tactus"] = {{"material", 7}, {"smell", "rose"}, {"look", {{"reflectance", 3}}}};
  document["meshes"][0]["primitives"][0]["attributes"]["_SMELL"] = 0;
  document["meshes"][0]["primitives"][0]["extensions"]["VENDOR_smell"] = 1;
  document["materials"][0]["extensions"]["KHR_materials_clearcoat"]["clearcoatFactor"] = 1;
  file.write("more.gltf", document.dump());
  const MeshParts more = read_mesh_parts(file.folder() / "more.gltf");
  CHECK(same_triangles(read_mesh_parts(file.folder() / "plain.gltf"), more));
  CHECK(more.material.empty());
  CHECK(more.look.empty());
  document["extensionsRequired"] = {"VENDOR_smell"};
  file.write("needs.gltf", document.dump());
  CHECK_THAT(why(file.folder() / "needs.gltf"), Catch::Contains("requires the extension VENDOR_smell"));
}

TEST_CASE(
    "The nodes of a glTF place its meshes, strips and fans become triangles, and mirrors keep the winding") {
  SceneFile file;
  nlohmann::json document = document_of(square());
  document["nodes"][0]["translation"] = {0, 0, 5};
  document["nodes"][0]["scale"] = {-1, 1, 1};
  document["nodes"].push_back({{"children", {0}}, {"rotation", {0, 0, 0.7071067811865476, 0.7071067811865476}}});
  document["scenes"][0]["nodes"] = {1};
  file.write("t.gltf", document.dump());
  const MeshPart part = read_mesh_parts(file.folder() / "t.gltf").parts.at(0);
  // (2, 0, 0) goes to (-2, 0, 5), and a quarter turn about z takes that to (0, -2, 5).
  CHECK((part.positions_m[1] - Vector3f(0, -2, 5)).norm() < 1e-6f);
  const auto at = [&](std::size_t k) { return part.positions_m[static_cast<std::size_t>(part.indices[k])]; };
  CHECK((at(1) - at(0)).cross(at(2) - at(0)).z() > 0);
  for (const auto& [mode, count] : {std::pair{5, 12}, {6, 12}, {4, 6}}) {
    nlohmann::json other = document_of(square());
    other["meshes"][0]["primitives"][0]["mode"] = mode;
    file.write("m.gltf", other.dump());
    CHECK(read_mesh_parts(file.folder() / "m.gltf").parts.at(0).indices.size() == static_cast<std::size_t>(count));
  }
}

TEST_CASE("A glTF without normals has smooth ones at small angles and split ones at large angles") {
  SceneFile file;
  for (const double bend_deg : {40.0, 60.0}) {
    MeshParts roof;
    MeshPart part;
    const auto c = static_cast<float>(std::cos(bend_deg * EIGEN_PI / 180)),
               s = static_cast<float>(std::sin(bend_deg * EIGEN_PI / 180));
    part.positions_m = {{0, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {c, 0, -s}};
    part.indices = {0, 1, 2, 0, 3, 1};
    roof.parts.push_back(part);
    const sync::Bytes bytes = write_gltf(roof, true);
    file.write("roof.glb", {bytes.begin(), bytes.end()});
    const MeshPart read = read_mesh_parts(file.folder() / "roof.glb").parts.at(0);
    CHECK(read.positions_m.size() == (bend_deg < 50 ? 4u : 6u));
    const Vector3f left(0, 0, 1), right(s, 0, c);
    const Vector3f ridge = read.normals[static_cast<std::size_t>(read.indices[0])];
    CHECK((ridge - (bend_deg < 50 ? Vector3f((left + right).normalized()) : left)).norm() < 1e-6f);
  }
}

TEST_CASE("A glTF with invalid buffers, accessors, indices or nodes is rejected with the reason") {
  SceneFile file;
  const auto rejection = [&](auto change) {
    nlohmann::json document = document_of(square());
    change(document);
    file.write("t.gltf", document.dump());
    const std::string said = why(file.folder() / "t.gltf");
    CHECK(said != "");
    CHECK(said.size() < 200);
    return said;
  };
  using J = nlohmann::json;
  CHECK_THAT(rejection([](J& d) { d["buffers"][0]["byteLength"] = 1'000'000; }),
             Catch::Contains("shorter than its byteLength"));
  CHECK_THAT(rejection([](J& d) { d["bufferViews"][0]["byteLength"] = 1'000'000; }),
             Catch::Contains("beyond its buffer"));
  CHECK_THAT(rejection([](J& d) { d["bufferViews"][0]["byteOffset"] = 4294967295.0; }),
             Catch::Contains("beyond its buffer"));
  CHECK_THAT(rejection([](J& d) { d["bufferViews"][0]["byteOffset"] = -4; }), Catch::Contains("not a count"));
  CHECK_THAT(rejection([](J& d) { d["bufferViews"][0]["byteStride"] = 4; }), Catch::Contains("beyond its view"));
  CHECK_THAT(rejection([](J& d) { d["bufferViews"][0]["buffer"] = 7; }), Catch::Contains("beyond its buffer"));
  CHECK_THAT(rejection([](J& d) { d["accessors"][0]["count"] = 5; }), Catch::Contains("beyond its view"));
  CHECK_THAT(rejection([](J& d) { d["accessors"][0]["count"] = 4'000'000'000.0; }), Catch::Contains("vertices"));
  CHECK_THAT(rejection([](J& d) { d["accessors"][0]["count"] = 1e300; }), Catch::Contains("not a count"));
  CHECK_THAT(rejection([](J& d) { d["accessors"][0]["componentType"] = 1; }), Catch::Contains("component type"));
  CHECK_THAT(rejection([](J& d) { d["accessors"][0]["type"] = "MAT4"; }), Catch::Contains("MAT4"));
  CHECK_THAT(rejection([](J& d) { d["accessors"][0]["type"] = "VEC2"; }), Catch::Contains("type"));
  CHECK_THAT(rejection([](J& d) { d["accessors"][0]["byteOffset"] = 8; }), Catch::Contains("beyond its view"));
  CHECK_THAT(rejection([](J& d) { d["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = 99; }),
             Catch::Contains("accessors"));
  CHECK_THAT(rejection([](J& d) { d["meshes"][0]["primitives"][0]["indices"] = 0; }), Catch::Contains("type"));
  CHECK_THAT(rejection([](J& d) { d["meshes"][0]["primitives"][0]["material"] = 3; }), Catch::Contains("materials"));
  CHECK_THAT(rejection([](J& d) { d["nodes"][0]["mesh"] = 12; }), Catch::Contains("meshes"));
  CHECK_THAT(rejection([](J& d) { d["nodes"][0]["children"] = {0}; }), Catch::Contains("not a tree"));
  CHECK_THAT(rejection([](J& d) { d["nodes"][0]["children"] = {"x"}; }), Catch::Contains("nodes"));
  CHECK_THAT(rejection([](J& d) { d["nodes"][0]["scale"] = {0, "a", 1}; }), Catch::Contains("not finite"));
  CHECK_THAT(rejection([](J& d) { d["buffers"][0]["uri"] = "no.bin"; }), Catch::Contains("no.bin"));
  CHECK_THAT(rejection([](J& d) { d["buffers"][0]["uri"] = "/dev/zero"; }), Catch::Contains("not a regular file"));
  CHECK_THAT(rejection([](J& d) { d["buffers"][0]["uri"] = "data:x;base64,????"; }), Catch::Contains("base64"));
  CHECK_THAT(rejection([](J& d) { d["asset"]["version"] = "1.0"; }), Catch::Contains("2.0"));
  CHECK_THAT(rejection([](J& d) { d.erase("scenes"); }), Catch::Contains("no scene"));
  for (const char* list : {"accessors", "bufferViews", "buffers", "nodes", "meshes"}) {
    INFO(list);
    rejection([&](J& d) { d[list] = 3; });
    if (list != std::string("meshes")) rejection([&](J& d) { d[list] = J::array({{{"mesh", 9}}}); });
  }
}

TEST_CASE("A truncated or corrupted .glb file is read or rejected without side effects") {
  SceneFile file;
  MeshParts mesh = square();
  make_tangents(mesh.parts[0]);
  const sync::Bytes whole = write_gltf(mesh, true);
  for (std::size_t size = 0; size < whole.size(); size += 7) {
    file.write("t.glb", {whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)});
    CHECK(why(file.folder() / "t.glb") != "");
  }
  std::uint32_t random = 1;
  int rejected = 0;
  for (int i = 0; i < 400; ++i) {
    sync::Bytes changed = whole;
    random = random * 1664525u + 1013904223u;
    changed[(random >> 8) % changed.size()] ^= static_cast<std::uint8_t>(1u << (random >> 29));
    file.write("t.glb", {changed.begin(), changed.end()});
    rejected += why(file.folder() / "t.glb") != "";
  }
  CHECK(rejected > 0);
}

TEST_CASE("Deep or very large JSON is rejected before it is stored") {
  SceneFile file;
  file.write("deep.gltf", std::string(1'000'000, '['));
  CHECK_THAT(why(file.folder() / "deep.gltf"), Catch::Contains("too deep"));
  std::string wide = "[0";
  for (int i = 0; i < 4'100'000; ++i) wide += ",0";
  file.write("wide.gltf", wide + "]");
  CHECK_THAT(why(file.folder() / "wide.gltf"), Catch::Contains("too many values"));
}

TEST_CASE(
    "A PLY whose header declares billions of vertices, and an OBJ of millions of triangles, are "
    "refused at once") {
  SceneFile file;
  for (const char* format : {"ascii", "binary_little_endian"}) {
    file.write("t.ply", std::string("ply\nformat ") + format +
                            " 1.0\nelement vertex 4000000000\nproperty float x\nend_header\n0\n");
    CHECK_THAT(why(file.folder() / "t.ply"), Catch::Contains("its header declares more than 3000000 of vertex"));
  }
  std::string obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  for (int i = 0; i < 1'000'001; ++i) obj += "f 1 2 3\n";
  file.write("t.obj", obj);
  CHECK_THAT(why(file.folder() / "t.obj"), Catch::Contains("more than 1000000 triangles"));
}

TEST_CASE("A file that is not regular or is too large is rejected as a mesh") {
  SceneFile file;
  std::filesystem::create_directory(file.folder() / "folder.obj");
  REQUIRE(mkfifo((file.folder() / "pipe.glb").c_str(), 0600) == 0);
  std::filesystem::create_symlink("/dev/zero", file.folder() / "zero.stl");
  file.write("sparse.ply", "ply\n");
  std::filesystem::resize_file(file.folder() / "sparse.ply", std::uintmax_t{4} << 30);
  CHECK(why(file.folder() / "none.obj") == "it does not exist");
  for (const char* name : {"folder.obj", "pipe.glb", "zero.stl"})
    CHECK(why(file.folder() / name) == "it is not a regular file");
  CHECK(why(file.folder() / "sparse.ply") == "it is larger than 128 MiB");
  SECTION("it is ignored as a material file") {
    file.write("t.obj", "mtllib zero.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    std::filesystem::create_symlink("/dev/zero", file.folder() / "zero.mtl");
    CHECK(read_mesh_parts(file.folder() / "t.obj").parts.size() == 1);
  }
  SECTION("a scene that names it is rejected with the line") {
    for (const char* name : {"folder.obj", "pipe.glb", "zero.stl", "sparse.ply"}) {
      file.write("scene.sdf", link(collision(std::string("\n<mesh><uri>") + name + "</uri></mesh>")));
      CHECK_THAT(file.load_error(), Catch::StartsWith("scene.sdf:6: ") && Catch::Contains(name));
    }
  }
}

TEST_CASE("Tangents follow u and binormals v, and a mirrored picture splits shared vertices") {
  MeshPart part = square().parts[0];
  make_tangents(part);
  REQUIRE(part.tangents.size() == 4);
  for (const Vector4f& t : part.tangents) CHECK((t - Vector4f(1, 0, 0, 1)).norm() < 1e-6f);
  MeshPart mirrored = square().parts[0];
  mirrored.texcoords = {{0, 0}, {1, 0}, {1, 1}, {1, 0}};  // the second triangle has it reversed
  make_tangents(mirrored);
  REQUIRE(mirrored.positions_m.size() == 6);
  REQUIRE(mirrored.indices.size() == 6);
  for (std::size_t c = 0; c < 6; ++c) {
    const auto v = static_cast<std::size_t>(mirrored.indices[c]);
    CHECK(mirrored.tangents[v].w() == (c < 3 ? 1 : -1));
    CHECK(mirrored.positions_m[v] ==
          square().parts[0].positions_m[static_cast<std::size_t>(square().parts[0].indices[c])]);
    // The binormal points in the direction of growing v: +y for the first triangle, +x for the second.
    const Vector3f n = mirrored.normals[v], t = mirrored.tangents[v].head<3>();
    const Vector3f b = mirrored.tangents[v].w() * n.cross(t);
    CHECK((b - (c < 3 ? Vector3f(0, 1, 0) : Vector3f(1, 0, 0))).norm() < 1e-6f);
  }
}
