#include "sim_node/scene/meshes/confined_reader.h"

#include "sim_node/scene/meshes/mesh_packing.h"
#include "sim_node/scene/meshes/mesh_reader.h"
#include "sync/sandbox/reader_process.h"
#include "sync/sandbox/regular_file.h"

namespace tactus::sim {

MeshParts read_mesh_parts_confined(const std::filesystem::path& file,
                                   const std::vector<std::filesystem::path>& folders) {
  sync::check_regular_file(file, kMaxMeshFileBytes);
  std::vector<std::string> arguments{std::filesystem::absolute(file).string()};
  for (const auto& folder : folders) arguments.push_back(std::filesystem::absolute(folder).string());
  MeshParts mesh = unpack_mesh(sync::read_in_process("read_geometry", arguments));
  check_mesh_parts(mesh);
  return mesh;
}

}  // namespace tactus::sim
