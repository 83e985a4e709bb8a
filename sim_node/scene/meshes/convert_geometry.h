// Converts a geometry file to glTF 2.0 with additional properties of the object. Used by convert_geometry_main.cpp.
#pragma once

#include <filesystem>

#include "sim_node/scene/meshes/mesh_parts.h"

namespace tactus::sim {

// The parts with tangents where they have texture coordinates; picture and property paths are made relative to the
// folder of `out` instead of that of `in`.
MeshParts with_output_paths(MeshParts mesh, const std::filesystem::path& in, const std::filesystem::path& out);

// Equality to the bit, except for names that are not UTF-8.
bool bit_identical(const MeshParts& a, const MeshParts& b);

// Throws std::runtime_error with one clause when a file that a property names is missing or invalid.
void check_properties(const MeshParts& mesh, const std::filesystem::path& out);

// Writes `out`, .glb or .gltf, atomically, and reads it back. Throws std::runtime_error with one clause.
void write_and_verify(const MeshParts& mesh, const std::filesystem::path& out);

}  // namespace tactus::sim
