// Separating axes of two convex cores: face normals, edge pairs, and the direction between slightly shrunk cores
// where none of these is best. Pure.
#pragma once

#include "sim_node/collision/gaps/convex.h"

namespace tactus::sim::gaps {

struct SeparatingAxis {
  Eigen::Vector3d along{0, 0, 0};  // unit, from a to b, in the frame of a; zero: none found
  double gap_m = -1e300;           // of the cores along it; at most their distance
};

// Best separating axis among the face normals of boxes, caps and triangles.
SeparatingAxis best_face_axis(const Convex& a, const Convex& b, const Eigen::Isometry3d& a_from_b);
// For cores that overlap or touch: the best of face normals, edge pairs and the direction between shrunk cores.
// Always finds an axis.
SeparatingAxis overlap_axis(const Convex& a, const Convex& b, const Eigen::Isometry3d& a_from_b);

}  // namespace tactus::sim::gaps
