// Which four of a contact's points a step needs when some of them are still apart. Pure.
#pragma once

#include <span>

#include "sim_node/model/manifold.h"

namespace tactus::sim::gaps {

// The nearest, then each time the one that is furthest from those chosen, less what its surfaces are further
// apart: far off and far to the side is what a body must turn a lot for. Directions that differ count as places
// that do, so that floor and wall of one mesh are both there. Fills out.points and out.count; of equals the first.
void choose_points(std::span<const ManifoldPoint> found, Manifold& out);

}  // namespace tactus::sim::gaps
