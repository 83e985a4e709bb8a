// Reads a triangle mesh file (OBJ, STL, DAE, glTF, PLY, ...) with assimp.
#pragma once

#include <filesystem>
#include <string>

#include "sim_node/scene/world_def.h"

namespace tactus::sim {

// Only the submesh of that name (of a mesh or of its node); empty: all. `centre` moves its bounding box's centre to the
// origin. Throws std::runtime_error with one clause that says what is wrong with the file.
TriangleMesh read_mesh(const std::filesystem::path& file, const std::string& submesh, bool centre,
                       const Eigen::Vector3d& scale);

}  // namespace tactus::sim
