// Reads a geometry file: glTF 2.0 (.gltf, .glb) with gltf_reader.h, every other format with assimp.
#pragma once

#include <filesystem>

#include "sim_node/scene/meshes/mesh_parts.h"

namespace tactus::sim {

// A mesh of a million triangles is some 100 MB as OBJ; of what is larger, reading alone would take minutes
// (design).
constexpr std::uintmax_t kMaxMeshFileBytes = 128 << 20;

// Numbers are metres and z is up, whatever the format's own convention. Throws std::runtime_error with one clause
// that says what is wrong with the file. What a format holds beyond MeshParts is ignored.
MeshParts read_mesh_parts(const std::filesystem::path& file);

}  // namespace tactus::sim
