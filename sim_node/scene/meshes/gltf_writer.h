// Writes glTF 2.0: triangles, materials, and Tactus properties in "extras".
#pragma once

#include "sim_node/scene/meshes/mesh_parts.h"

namespace tactus::sim {

// The bytes of a .glb, or of a .gltf with its buffer inside; one node and one mesh per part. read_gltf restores
// parts, materials and properties identically to the bit; normals must be unit vectors or 0.
sync::Bytes write_gltf(const MeshParts& mesh, bool packed);

}  // namespace tactus::sim
