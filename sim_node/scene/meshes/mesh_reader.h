// Reads a geometry file: glTF 2.0 (.gltf, .glb) with gltf_reader.h, every other format with assimp.
#pragma once

#include <filesystem>
#include <vector>

#include "sim_node/scene/meshes/mesh_parts.h"

namespace tactus::sim {

// A mesh of a million triangles is about 100 MB as OBJ; reading a larger file would take minutes (design).
constexpr std::uintmax_t kMaxMeshFileBytes = 128 << 20;

// Units are metres and z is up, for all formats. The file may name others (material libraries, buffers), which are read
// below `folders` only; empty: below its own folder. Throws std::runtime_error with one clause when the file is invalid.
// Ignores content that MeshParts cannot hold. Parses in this process: for a file that may be hostile, use
// read_mesh_parts_confined (confined_reader.h).
MeshParts read_mesh_parts(const std::filesystem::path& file, const std::vector<std::filesystem::path>& folders = {});

// Checks sizes, indices and numbers, and completes normals and tangents that a file may leave invalid. Throws
// std::runtime_error with one clause.
void check_mesh_parts(MeshParts& mesh);

}  // namespace tactus::sim
