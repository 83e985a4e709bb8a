// Tests of the sentences for files that assimp does not read.
#include "sim_node/scene/meshes/assimp_reason.h"

#include <catch2/catch.hpp>
#include <tuple>

#include "sim_node/scene/meshes/mesh_file.h"
#include "tests/sim_node/support/scene_file.h"

using namespace tactus::sim;

namespace {

std::string refusal_of(const SceneFile& file, const std::string& name) {
  try {
    read_mesh(file.folder() / name, "", false, Eigen::Vector3d::Ones());
    return "";
  } catch (const std::runtime_error& e) {
    return e.what();
  }
}

}  // namespace

TEST_CASE("A damaged mesh is refused with a reason and a remedy, and without the words of the library") {
  SceneFile file;
  const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  const std::tuple<std::string, std::string, std::string> cases[] = {
      {"points.obj", triangle + "p 1\n", "it holds no surface"},
      {"lines.obj", triangle + "l 1 2\n", "it holds no surface"},
      {"empty.obj", "", "it is empty or cut off"},
      {"words.obj", "hello world\n", "it is empty or cut off"},
      {"index.obj", triangle + "f 1 2 7\n", "a face names a vertex that the file does not hold"},
      {"empty.stl", "", "it is empty or cut off"},
      {"words.stl", "hello, this is a text and no STL file, and it is longer than the head of one, which has eighty bytes\n", "it is no STL file"},
      {"magic.ply", "plx\nformat ascii 1.0\nend_header\n", "it does not begin with the word ply"},
      {"none.ply", "ply\nformat ascii 1.0\nend_header\n", "it holds no surface"},
      {"index.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
                    "property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2147483647\n",
       "face 1 names a vertex that the file does not hold"},
      {"noise.xyz", "\x01\x02 nothing that any reader knows", "its format is not known"},
      {"noise.3ds", std::string(200, '\x7f'), "its contents are not those of a .3ds file"},
  };
  for (const auto& [name, text, words] : cases) {
    INFO(name);
    file.write(name, text);
    const std::string reason = refusal_of(file, name);
    CAPTURE(reason);
    CHECK(reason.find(words) != std::string::npos);
    CHECK(reason.find("; ") != std::string::npos);
    CHECK(reason.find(file.folder().string()) == std::string::npos);  // the caller names the file
  }
}

TEST_CASE("A text of assimp without a clause of its own is one short line without the path") {
  const std::string text = "Oops in /a/b.fbx\nline 2: " + std::string(500, 'x') + ".";
  const std::string reason = assimp_reason("/a/b.fbx", text);
  CHECK(reason.starts_with("its contents are not those of a .fbx file (Oops in  line 2: xxx"));
  CHECK(reason.ends_with("); export it again, or as glTF"));
  CHECK(reason.size() < 260);
  CHECK(assimp_reason("/a/b.fbx", "") == "its contents are not those of a .fbx file; export it again, or as glTF");
}

TEST_CASE("The unit of a COLLADA file is applied, and its up axis is not") {
  SceneFile file;
  file.write("cm.dae", R"(<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><asset><unit
 meter="0.01"/><up_axis>Y_UP</up_axis></asset><library_geometries><geometry id="g" name="g"><mesh><source id="p"><float_array id="a"
 count="9">0 0 0 2 0 0 0 3 0</float_array><technique_common><accessor source="#a" count="3" stride="3"><param name="X"
 type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source><vertices
 id="v"><input semantic="POSITION" source="#p"/></vertices><triangles count="1"><input semantic="VERTEX" source="#v"
 offset="0"/><p>0 1 2</p></triangles></mesh></geometry></library_geometries><library_visual_scenes><visual_scene id="s"><node
 id="n"><instance_geometry url="#g"/></node></visual_scene></library_visual_scenes><scene><instance_visual_scene url="#s"/></scene>
</COLLADA>)");
  const TriangleMesh mesh = read_mesh(file.folder() / "cm.dae", "", false, Eigen::Vector3d::Ones());
  Eigen::Vector3d largest = Eigen::Vector3d::Zero();
  for (const auto& v : mesh.vertices) largest = largest.cwiseMax(v.cwiseAbs());
  CHECK((largest - Eigen::Vector3d(0.02, 0.03, 0)).norm() < 1e-7);  // the file is read in single precision
}
