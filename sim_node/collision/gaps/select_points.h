// Reduces a contact to four points when some points still have a gap. Pure.
#pragma once

#include <span>

#include "sim_node/model/manifold.h"

namespace tactus::sim::gaps {

// Selects the point with the least gap, then repeatedly the point furthest from those selected, with a penalty for
// its additional gap: a body must rotate far to close a large gap. A difference of normals counts as a distance,
// so that floor and wall of one mesh are both represented. Fills out.points and out.count. The first of equal
// points wins.
void select_points(std::span<const ManifoldPoint> found, Manifold& out);

}  // namespace tactus::sim::gaps
