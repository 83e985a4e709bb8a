// The triangles of a geometry file as a mesh of the world.
#pragma once

#include <filesystem>
#include <set>
#include <string>

#include "sim_node/scene/meshes/mesh_parts.h"
#include "sim_node/model/world_def.h"

namespace tactus::sim {

// Selection and placement of the parts of a file: only the submesh of that name (of a mesh or its node), empty: all.
// `centre` moves the centre of their bounding box to the origin, before scaling.
struct MeshSelection {
  std::string submesh;
  bool centre = false;
  Eigen::Vector3d scale{1, 1, 1};
};

bool is_selected(const MeshPart& part, const MeshSelection& selection);

// The selected parts as one mesh; with `only`, the parts with these materials, but centred as the whole selection.
// Texture coordinates and tangents are kept if every part has them. Throws std::runtime_error with one clause when no
// triangle is left.
TriangleMesh join_parts(const MeshParts& mesh, const MeshSelection& selection,
                        const std::set<int>* only = nullptr);

// Throws std::runtime_error with one clause when the file is invalid.
TriangleMesh read_mesh(const std::filesystem::path& file, const std::string& submesh, bool centre,
                       const Eigen::Vector3d& scale);

}  // namespace tactus::sim
