// Directions along which two convex cores part: those of their faces and edges, and where none of these is the
// best, that of slightly smaller cores. Pure.
#pragma once

#include "sim_node/collision/gaps/convex.h"

namespace tactus::sim::gaps {

struct Parting {
  Eigen::Vector3d along{0, 0, 0};  // unit, from a to b, in the frame of a; zero: none found yet
  double gap_m = -1e300;           // of the cores along it; never more than their distance
};

// The best of the directions of faces, that is of boxes, caps and triangles.
Parting over_faces(const Convex& a, const Convex& b, const Eigen::Isometry3d& a_from_b);
// For cores that overlap or touch: faces, pairs of edges, and the direction between cores that are shrunk until
// they are apart. Never none.
Parting out_of_overlap(const Convex& a, const Convex& b, const Eigen::Isometry3d& a_from_b);

}  // namespace tactus::sim::gaps
