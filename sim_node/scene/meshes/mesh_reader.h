// Reads a geometry file: glTF 2.0 (.gltf, .glb) with gltf_reader.h, every other format with assimp.
#pragma once

#include <filesystem>

#include "sim_node/scene/meshes/mesh_parts.h"

namespace tactus::sim {

// A mesh of a million triangles is about 100 MB as OBJ; reading a larger file would take minutes (design).
constexpr std::uintmax_t kMaxMeshFileBytes = 128 << 20;

// Units are metres and z is up, for all formats. Throws std::runtime_error with one clause when the file is invalid.
// Ignores content that MeshParts cannot hold.
MeshParts read_mesh_parts(const std::filesystem::path& file);

}  // namespace tactus::sim
