// Triangles of a world from a geometry file.
#pragma once

#include <filesystem>
#include <set>
#include <string>

#include "sim_node/scene/meshes/mesh_parts.h"
#include "sim_node/model/world_def.h"

namespace tactus::sim {

// Which of the parts of a file, and how they stand: only the submesh of that name (of a mesh or of its node), empty: all;
// `centre` moves the centre of the bounding box of these to the origin, before the scale.
struct MeshChoice {
  std::string submesh;
  bool centre = false;
  Eigen::Vector3d scale{1, 1, 1};
};

bool is_chosen(const MeshPart& part, const MeshChoice& choice);

// The chosen parts as one mesh. Of the parts with a material of `only` when that is given; the centre is still that of all chosen.
// Texture coordinates and tangents, when each has them. Throws std::runtime_error with one clause when there is no triangle.
TriangleMesh join_parts(const MeshParts& mesh, const MeshChoice& choice, const std::set<int>* only = nullptr);

// Throws std::runtime_error with one clause that says what is wrong with the file.
TriangleMesh read_mesh(const std::filesystem::path& file, const std::string& submesh, bool centre,
                       const Eigen::Vector3d& scale);

}  // namespace tactus::sim
