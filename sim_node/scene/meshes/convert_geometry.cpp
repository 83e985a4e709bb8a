#include "sim_node/scene/meshes/convert_geometry.h"

#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <stdexcept>

#include "sim_node/scene/meshes/gltf_writer.h"
#include "sim_node/scene/materials/height_image.h"
#include "sim_node/model/measured_modes.h"
#include "sim_node/scene/meshes/mesh_reader.h"
#include "sim_node/scene/materials/pictures.h"
#include "sim_node/scene/meshes/tangents.h"
#include "sync/pictures/confined_pictures.h"

namespace tactus::sim {
namespace {

namespace fs = std::filesystem;

const char* const kFilesOfMaterial[] = {"bump", "friction_map", "modes"};
const char* const kFilesOfLook[] = {"colour_map", "normal_map"};

std::string moved(const std::string& file, const fs::path& from, const fs::path& to) {
  if (file.empty() || fs::path(file).is_absolute()) return file;
  return fs::relative(from / file, to).generic_string();
}

fs::path folder_of(const fs::path& file) { return fs::absolute(file).parent_path(); }

bool same(const MeshPart& a, const MeshPart& b) {
  return a.material == b.material && a.positions_m == b.positions_m && a.normals == b.normals &&
         a.texcoords == b.texcoords && a.tangents == b.tangents && a.indices == b.indices;
}

}  // namespace

MeshParts with_output_paths(MeshParts mesh, const fs::path& in, const fs::path& out) {
  const fs::path from = folder_of(in), to = folder_of(out);
  std::erase_if(mesh.parts, [](const MeshPart& part) { return part.indices.empty(); });
  for (MeshPart& part : mesh.parts) make_tangents(part);
  for (MeshMaterial& m : mesh.materials)
    for (MeshPicture* picture : {&m.colour_map, &m.normal_map}) picture->file = moved(picture->file, from, to);
  for (const char* key : kFilesOfMaterial)
    if (mesh.material.contains(key)) mesh.material[key] = moved(mesh.material[key], from, to);
  for (const char* key : kFilesOfLook)
    if (mesh.look.contains(key)) mesh.look[key] = moved(mesh.look[key], from, to);
  return mesh;
}

bool bit_identical(const MeshParts& a, const MeshParts& b) {
  const auto same_material = [](const MeshMaterial& x, const MeshMaterial& y) {
    return x.diffuse == y.diffuse && x.specular == y.specular && x.emissive == y.emissive &&
           x.shininess == y.shininess && x.alpha == y.alpha && x.colour_map == y.colour_map &&
           x.normal_map == y.normal_map;
  };
  return std::equal(a.parts.begin(), a.parts.end(), b.parts.begin(), b.parts.end(), same) &&
         std::equal(a.materials.begin(), a.materials.end(), b.materials.begin(), b.materials.end(),
                    same_material) &&
         a.material == b.material && a.look == b.look;
}

void check_properties(const MeshParts& mesh, const fs::path& out) {
  const auto check = [&](const Properties& properties, const char* key, auto read) {
    const auto at = properties.find(key);
    if (at == properties.end() || at->second.empty()) return;
    try {
      read(read_image_file(folder_of(out) / at->second));
    } catch (const std::exception& e) {
      throw std::runtime_error(std::string(key) + " \"" + at->second + "\" cannot be read: " + e.what());
    }
  };
  sync::ConfinedPictures pictures;
  for (const char* key : {"bump", "friction_map"})
    check(mesh.material, key, [&](const sync::Bytes& b) { pictures.height_map(b); });
  check(mesh.material, "modes", [](const sync::Bytes& b) {
    parse_measured_modes({reinterpret_cast<const char*>(b.data()), b.size()});
  });
  check(mesh.look, "colour_map", [](const sync::Bytes& b) { check_picture(b, PictureUse::kColour); });
  check(mesh.look, "normal_map", [](const sync::Bytes& b) { check_picture(b, PictureUse::kDirections); });
}

void write_and_verify(const MeshParts& mesh, const fs::path& out) {
  if (mesh.parts.empty()) throw std::runtime_error("there is no triangle to write");
  const sync::Bytes bytes = write_gltf(mesh, out.extension() == ".glb");
  // Keep the extension, which selects the reader; the process id makes the name unique.
  const fs::path temporary = out.parent_path() / ("." + std::to_string(getpid()) + out.filename().string());
  std::error_code error;
  try {
    std::ofstream file(temporary, std::ios::binary);
    file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    file.close();
    if (!file) throw std::runtime_error("it cannot be written");
    if (!bit_identical(read_mesh_parts(temporary), mesh))
      throw std::runtime_error("it reads back differently, so it is not written");
    fs::rename(temporary, out, error);
    if (error) throw std::runtime_error("it cannot be written: " + error.message());
  } catch (...) {
    fs::remove(temporary, error);
    throw;
  }
}

}  // namespace tactus::sim
