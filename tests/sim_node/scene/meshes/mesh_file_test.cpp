#include "sim_node/scene/meshes/mesh_file.h"

#include "tests/sim_node/support/scene_file.h"
#include "sim_node/model/triangles.h"

using namespace tactus::sim;
using Eigen::Vector3d;

namespace {
// One triangle in the plane z = 0, in each format; its normal is +z.
const char* kObj = "o first\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\no second\nv 0 0 5\nv 2 0 5\nv 0 2 5\nf 4 5 6\n";
const char* kStl = "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid s\n";
const char* kPly =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
    "property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
const char* kDae = R"(<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><asset><unit
 meter="1"/><up_axis>Z_UP</up_axis></asset><library_geometries><geometry id="g" name="g"><mesh><source id="p"><float_array id="a"
 count="9">0 0 0 1 0 0 0 1 0</float_array><technique_common><accessor source="#a" count="3" stride="3"><param name="X"
 type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source><vertices
 id="v"><input semantic="POSITION" source="#p"/></vertices><triangles count="1"><input semantic="VERTEX" source="#v"
 offset="0"/><p>0 1 2</p></triangles></mesh></geometry></library_geometries><library_visual_scenes><visual_scene id="s"><node
 id="n"><instance_geometry url="#g"/></node></visual_scene></library_visual_scenes><scene><instance_visual_scene url="#s"/></scene>
</COLLADA>)";
// Positions as 36 bytes of base64: three float vectors; and the indices 0 1 2 as shorts.
const char* kGltf = R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],"meshes":[{"primitives":[
{"attributes":{"POSITION":0},"indices":1}]}],"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],
"max":[1,1,0]},{"bufferView":1,"componentType":5123,"count":3,"type":"SCALAR"}],"bufferViews":[{"buffer":0,"byteOffset":0,
"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":6}],"buffers":[{"byteLength":42,"uri":
"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAABAAIA"}]})";
const Vector3d kOne = Vector3d::Ones();
}  // namespace

TEST_CASE("OBJ, STL, PLY, DAE and glTF files of a triangle give the same mesh") {
  SceneFile file;
  for (const auto& [name, text] : {std::pair{"t.stl", kStl}, {"t.ply", kPly}, {"t.dae", kDae}, {"t.gltf", kGltf}}) {
    INFO(name);
    file.write(name, text);
    const TriangleMesh mesh = read_mesh(file.folder() / name, "", false, kOne);
    REQUIRE(mesh.vertices.size() == 3);
    REQUIRE(mesh.indices.size() == 3);
    const Vector3d a = mesh.vertices[static_cast<std::size_t>(mesh.indices[0])];
    const Vector3d b = mesh.vertices[static_cast<std::size_t>(mesh.indices[1])];
    const Vector3d c = mesh.vertices[static_cast<std::size_t>(mesh.indices[2])];
    CHECK(((b - a).cross(c - a) - Vector3d::UnitZ()).norm() < 1e-6);
    CHECK((mesh.normals[0] - Vector3d::UnitZ()).norm() < 1e-6);  // made where the file has none
  }
}

TEST_CASE("A submesh is loaded alone and moved to its centre") {
  SceneFile file;
  file.write("t.obj", kObj);
  CHECK(read_mesh(file.folder() / "t.obj", "", false, kOne).indices.size() == 6);
  const TriangleMesh second = read_mesh(file.folder() / "t.obj", "second", false, kOne);
  REQUIRE(second.indices.size() == 3);
  CHECK(second.vertices[0].z() == 5);
  const TriangleMesh centred = read_mesh(file.folder() / "t.obj", "second", true, {1, 1, 2});
  CHECK(bounds(centred, Eigen::Isometry3d::Identity()).center().norm() < 1e-6);
  CHECK_THROWS_WITH(read_mesh(file.folder() / "t.obj", "third", false, kOne), Catch::Contains("no submesh \"third\""));
}

TEST_CASE("A mirrored mesh keeps its orientation") {
  SceneFile file;
  file.write("t.obj", kObj);
  const TriangleMesh m = read_mesh(file.folder() / "t.obj", "first", false, {-1, 1, 1});
  const auto at = [&](int k) { return m.vertices[static_cast<std::size_t>(m.indices[static_cast<std::size_t>(k)])]; };
  CHECK((at(1) - at(0)).cross(at(2) - at(0)).z() > 0);
  CHECK(m.normals[0].z() > 0.99);
}

TEST_CASE("Missing normals are the mean of the adjacent faces") {
  TriangleMesh roof;
  roof.vertices = {{0, 0, 1}, {0, 1, 1}, {1, 0, 0}, {-1, 0, 0}};
  roof.indices = {0, 2, 1, 0, 1, 3};
  complete_normals(roof);
  CHECK((roof.normals[0] - Vector3d::UnitZ()).norm() < 1e-12);  // the ridge
  CHECK((roof.normals[2] - Vector3d(1, 0, 1).normalized()).norm() < 1e-12);
}

TEST_CASE("A byte order mark changes no mesh, also when its first line is a vertex") {
  SceneFile file;
  file.write("plain.obj", std::string(kObj).substr(8));  // begins with a vertex
  file.write("marked.obj", "\xEF\xBB\xBF" + std::string(kObj).substr(8));
  const TriangleMesh plain = read_mesh(file.folder() / "plain.obj", "", false, kOne), marked = read_mesh(file.folder() / "marked.obj", "", false, kOne);
  CHECK(plain.indices == marked.indices);
  CHECK(plain.vertices == marked.vertices);
}
