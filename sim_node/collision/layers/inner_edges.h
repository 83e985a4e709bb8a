// Edges between two triangles of one flat face, such as the diagonal of the side of a box: no edges of the surface.
#pragma once

#include <vector>

#include "sim_node/collision/layers/obb_tree.h"

namespace tactus::sim {

// Sets Triangle::inner. An edge is inside a face when exactly two triangles have it and their normals are equal. Corners with
// equal coordinates are one.
void mark_inner_edges(std::vector<Triangle>& triangles);

}  // namespace tactus::sim
