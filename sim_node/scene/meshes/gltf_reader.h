// Reads triangles, materials and what is ours out of a glTF 2.0 file.
#pragma once

#include <filesystem>

#include "sim_node/scene/meshes/mesh_parts.h"

namespace tactus::sim {

// As read_mesh_parts (mesh_reader.h): every triangle of the file's scene where its node stands at rest; skins,
// shapes that change, cameras and lights are ignored. A part without normals gets them with an edge above
// kCrease_deg. A file that write_gltf wrote is read to the bit.
MeshParts read_gltf(const std::filesystem::path& file);

// The vertical texture coordinate, upwards: glTF's own is 1 - v, which rounds. A reader who does not know it takes
// TEXCOORD_0 and is off by less than 6e-8.
constexpr const char* kExactV = "_TACTUS_V";

}  // namespace tactus::sim
