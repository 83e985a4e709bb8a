// Writes glTF 2.0: triangles, materials, and in "extras" what is ours.
#pragma once

#include "sim_node/scene/meshes/mesh_parts.h"

namespace tactus::sim {

// The bytes of a .glb, or of a .gltf with its buffer inside. A node and a mesh for each part. read_gltf gives the
// parts, materials and properties back to the bit; normals must be unit or 0.
sync::Bytes write_gltf(const MeshParts& mesh, bool packed);

}  // namespace tactus::sim
