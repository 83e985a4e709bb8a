// Tangents from texture coordinates, for normal maps.
#pragma once

#include "sim_node/scene/meshes/mesh_parts.h"

namespace tactus::sim {

// Fills part.tangents (mesh_t.lcm) where there are texture coordinates and normals but no tangents: the mean over the
// adjacent triangles, weighted by their angle at the vertex, orthogonal to the normal (Lengyel 2001, "Computing
// tangent space basis vectors for an arbitrary mesh"). A vertex with mirrored texture coordinates on one side is
// split; the second copy is appended.
void make_tangents(MeshPart& part);

}  // namespace tactus::sim
