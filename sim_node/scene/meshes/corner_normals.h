// Normals for triangles that have none: round where they bend a little, an edge where they bend much.
#pragma once

#include "sim_node/scene/meshes/mesh_parts.h"

namespace tactus::sim {

// The normal of a corner is the area-weighted mean over the triangles at its position whose direction differs from
// its own by less than the angle. Vertices are divided where their corners need different normals, and those that
// nobody uses are gone.
void make_corner_normals(MeshPart& part, float crease_deg);

}  // namespace tactus::sim
