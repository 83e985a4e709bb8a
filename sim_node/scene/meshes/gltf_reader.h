// Reads triangles, materials and Tactus properties from a glTF 2.0 file.
#pragma once

#include <filesystem>

#include "sim_node/scene/meshes/mesh_parts.h"
#include "sync/sandbox/readable_folders.h"

namespace tactus::sim {

// Same interface as read_mesh_parts (mesh_reader.h): every triangle of the file's scene, with its node in the rest
// pose; ignores skins, morph targets, cameras and lights. A part without normals gets them with an edge above
// kCrease_deg. A file written by write_gltf is read identically to the bit.
MeshParts read_gltf(const std::filesystem::path& file, const sync::ReadableFolders& readable);

// The vertical texture coordinate, upwards. glTF's own is 1 - v, which rounds. Other readers use TEXCOORD_0, with an
// error below 6e-8.
constexpr const char* kExactV = "_TACTUS_V";

}  // namespace tactus::sim
