// Normals for triangles without normals: smooth where the surface bends a little, an edge where it bends much.
#pragma once

#include "sim_node/scene/meshes/mesh_parts.h"

namespace tactus::sim {

// The normal of a corner is the area-weighted mean over the triangles at its position whose direction differs from
// its own by less than the angle. Vertices are split where their corners need different normals; unused vertices are
// removed.
void make_corner_normals(MeshPart& part, float crease_deg);

}  // namespace tactus::sim
