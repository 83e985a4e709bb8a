// Reduces a contact to four points for each of its faces when some points still have a gap. Pure.
#pragma once

#include <span>

#include "sim_node/model/manifold.h"

namespace tactus::sim::gaps {

// Points whose normals are alike belong to one face: floor and walls of one mesh are three. Of each face, selects the
// point with the least gap, then repeatedly the point furthest from those selected, with a penalty for its additional
// gap: a body must rotate far to close a large gap. A difference of normals counts as a distance. Faces are taken in
// the order of their least gap; points beyond the last face are left out. Fills out.points and out.count. The first of
// equal points wins.
void select_points(std::span<const ManifoldPoint> found, Manifold& out);

}  // namespace tactus::sim::gaps
