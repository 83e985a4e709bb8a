// Tangents from texture coordinates, for normal maps.
#pragma once

#include "sim_node/scene/meshes/mesh_parts.h"

namespace tactus::sim {

// Fills part.tangents (mesh_t.lcm) where there are texture coordinates and normals and none yet: the mean over the
// triangles around, weighted by their angle at the vertex, at right angles to the normal (Lengyel 2001, "Computing
// tangent space basis vectors for an arbitrary mesh"). A vertex at which the picture is mirrored on one side
// becomes two, the second at the end.
void make_tangents(MeshPart& part);

}  // namespace tactus::sim
