// Contact of two convex shapes, separated or overlapping: its normal and the corners of the contact area. Pure.
#pragma once

#include <vector>

#include "sim_node/collision/gaps/convex.h"
#include "sim_node/model/point_pair.h"

namespace tactus::sim::gaps {

// Appends the pairs with a gap of at most reach_m, which is positive. The least gap is exact for separated shapes and
// for overlapping faces or edges of boxes. For overlapping round shapes it is near the minimum translation. Real-time
// safe once the list has grown. Thread-safe.
void convex_pair(const Convex& a, const Eigen::Isometry3d& pose_a, const Convex& b,
                 const Eigen::Isometry3d& pose_b, double reach_m, std::vector<PointPair>& out);

// Appends the corners of a over or under the face of a triangle, regardless of the nearest feature: for example
// the far end of a tilted shape.
void over_face(const Convex& a, const Eigen::Isometry3d& pose_a, const Convex& triangle,
               const Eigen::Isometry3d& pose_b, double reach_m, std::vector<PointPair>& out);

// b against the half space whose outward normal is the z axis of plane_pose.
void plane_pair(const Eigen::Isometry3d& plane_pose, const Convex& b, const Eigen::Isometry3d& pose_b,
                double reach_m, std::vector<PointPair>& out);

}  // namespace tactus::sim::gaps
