// convert_geometry: converts a geometry file to glTF 2.0 with material, relief and appearance of the object.
// tactus convert calls it.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <tactus/material_def_t.hpp>

#include "sim_node/scene/meshes/convert_geometry.h"
#include "sim_node/scene/materials/materials.h"
#include "sim_node/scene/meshes/confined_reader.h"
#include "sync/node/node_options.h"

using namespace tactus;
using namespace tactus::sim;
namespace fs = std::filesystem;

namespace {

// An option, the attribute of docs/scene_format.md that it sets, and whether its value is a file name.
struct PropertyOption {
  const char* option;
  const char* attribute;
  bool of_look, is_file;
  const char* meaning;
  std::string value = {};
};

std::vector<PropertyOption> property_options() {
  return {{"--material", "base", false, false, "its material, for example steel"},
          {"--bump", "bump", false, true, "height map, a grey PNG"},
          {"--bump-size", "bump_size", false, false, "size of one repetition, for example \"0.16m 0.16m\""},
          {"--bump-height", "bump_height", false, false, "height of white above black, for example 1mm"},
          {"--friction-map", "friction_map", false, true, "friction map, a grey PNG"},
          {"--friction-size", "friction_size", false, false, "size of one repetition"},
          {"--friction-factors", "friction_factors", false, false, "factors of black and white, for example \"0.2 1.5\""},
          {"--modes", "modes", false, true, "table of its measured modes (tactus analyse-modes)"},
          {"--shader", "shader", true, false, "shader that draws it, for example reflecting"},
          {"--colour-map", "colour_map", true, true, "colour map, instead of those that IN names"},
          {"--normal-map", "normal_map", true, true, "normal map, instead of those that IN names"},
          {"--reflectance", "reflectance", true, false, "mirrored fraction of the light, 0 to 1"},
          {"--uniforms", "uniforms", true, false, "numbers for the shader, for example \"scale 2; tint 1 0.5 0\""}};
}

void reject(const std::string& sentence) { throw std::runtime_error(sentence); }

}  // namespace

int main(int argc, char** argv) try {
  std::string in, out;
  bool force = false;
  std::vector<PropertyOption> given = property_options();
  sync::Arguments app{"Reads OBJ, STL, PLY, 3DS, DAE, glTF and other formats of assimp, and writes glTF 2.0: positions, normals,\n"
               "tangents, texture coordinates, triangles and links to pictures, and the given properties in \"extras\". A scene that\n"
               "loads OUT uses these properties where it defines none itself. The file is read back and must be identical to the bit."};
  app.add_option("IN", in, "geometry file").required();
  app.add_option("OUT", out, ".glb, or .gltf with its buffer inside").required();
  app.add_flag("--force", force, "overwrite OUT when it exists");
  for (PropertyOption& word : given) app.add_option(word.option, word.value, word.meaning);
  sync::parse_or_exit(app, "convert_geometry", argc, argv);

  std::string extension = fs::path(out).extension().string();
  if (extension != ".glb" && extension != ".gltf")
    reject("\"" + out + "\" must end in .glb or .gltf: only glTF is written");
  if (fs::exists(out) && !force) reject("\"" + out + "\" exists already: give another name, or --force");
  if (!fs::is_directory(fs::absolute(out).parent_path()))
    reject("the folder of \"" + out + "\" does not exist: create it first");

  MeshParts mesh;
  try {
    mesh = with_output_paths(read_mesh_parts_confined(in), in, out);
  } catch (const std::exception& e) {
    reject("\"" + in + "\" cannot be read: " + e.what());
  }
  for (const PropertyOption& word : given) {
    if (word.value.empty()) continue;
    std::string value = word.value;
    if (word.is_file && !fs::path(value).is_absolute())
      value = fs::relative(fs::absolute(value), fs::absolute(out).parent_path()).generic_string();
    (word.of_look ? mesh.look : mesh.material)[word.attribute] = value;
  }
  if (!mesh.material.empty() && !mesh.material.contains("base"))
    reject("the material is missing: give --material, for example oak");
  const auto table = builtin_materials();
  const bool known = mesh.material.empty() || std::any_of(table.begin(), table.end(), [&](const material_def_t& m) {
    return m.name == mesh.material["base"];
  });
  if (!known)
    std::fprintf(stderr, "convert_geometry: \"%s\" is not a material of sim_node/scenes/materials.csv: the scene must define it\n",
                 mesh.material["base"].c_str());
  check_properties(mesh, out);
  try {
    write_and_verify(mesh, out);
  } catch (const std::exception& e) {
    reject("\"" + out + "\": " + e.what());
  }
  std::size_t triangles = 0;
  for (const MeshPart& part : mesh.parts) triangles += part.indices.size() / 3;
  std::printf("%s: %zu parts, %zu triangles, %zu materials; read back identically to the bit\n", out.c_str(), mesh.parts.size(), triangles,
              mesh.materials.size());
  return 0;
} catch (const std::exception& e) {
  return sync::fail("convert_geometry", e);
}
