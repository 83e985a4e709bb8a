// Makes a glTF 2.0 file of a geometry file, with what else is known of the object. Used by
// convert_geometry_main.cpp.
#pragma once

#include <filesystem>

#include "sim_node/scene/meshes/mesh_parts.h"

namespace tactus::sim {

// Its parts with tangents where they have texture coordinates, its pictures and properties named from where `out`
// lies instead of from where `in` lies.
MeshParts for_place(MeshParts mesh, const std::filesystem::path& in, const std::filesystem::path& out);

// The same to the bit, names aside that are no UTF-8.
bool same_to_the_bit(const MeshParts& a, const MeshParts& b);

// Throws std::runtime_error with one clause when a file that a property names is not there, or not what it must
// be.
void check_properties(const MeshParts& mesh, const std::filesystem::path& out);

// Writes `out`, .glb or .gltf, whole or not at all, and reads it back. Throws std::runtime_error with one clause.
void write_and_verify(const MeshParts& mesh, const std::filesystem::path& out);

}  // namespace tactus::sim
