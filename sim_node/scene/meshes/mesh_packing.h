// The content of a geometry file as bytes, between the process that parses it and this one.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sim_node/scene/meshes/mesh_parts.h"

namespace tactus::sim {

std::vector<std::uint8_t> pack(const MeshParts& mesh);

// Throws std::runtime_error with one clause when the bytes are incomplete. Checks sizes only: call check_mesh_parts
// (mesh_reader.h) on the result.
MeshParts unpack_mesh(std::span<const std::uint8_t> bytes);

}  // namespace tactus::sim
