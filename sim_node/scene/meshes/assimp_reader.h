// Reads a geometry file (OBJ, STL, PLY, 3DS, DAE, ...) with assimp.
#pragma once

#include <filesystem>

#include "sim_node/scene/meshes/mesh_parts.h"
#include "sync/sandbox/readable_folders.h"

namespace tactus::sim {

// Same interface as read_mesh_parts (mesh_reader.h). Merges repeated vertices; computes missing normals, with an
// edge where the direction changes by more than kCrease_deg. Other files that it names (mtllib) must be regular
// files, too.
MeshParts read_with_assimp(const std::filesystem::path& file, const sync::ReadableFolders& readable);

}  // namespace tactus::sim
