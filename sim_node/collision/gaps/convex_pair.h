// The contact of two convex bodies, apart or in each other: its direction, and the corners of what they turn
// towards each other. Pure.
#pragma once

#include <vector>

#include "sim_node/collision/gaps/convex.h"
#include "sim_node/model/point_pair.h"

namespace tactus::sim::gaps {

// Appends the pairs with a gap of at most the reach, which is positive. The least gap is exact where the bodies
// are apart, and where faces or edges of boxes overlap; where round ones overlap the way out is near the shortest.
// Realtime-safe once the list has grown; for any number of threads.
void convex_pair(const Convex& a, const Eigen::Isometry3d& pose_a, const Convex& b,
                 const Eigen::Isometry3d& pose_b, double reach_m, std::vector<PointPair>& out);

// The corners of a that lie over the face of a triangle or under it, whatever is nearest: of what is tilted, the
// other end.
void over_face(const Convex& a, const Eigen::Isometry3d& pose_a, const Convex& triangle,
               const Eigen::Isometry3d& pose_b, double reach_m, std::vector<PointPair>& out);

// b over the half space that plane_pose's z leads out of.
void plane_pair(const Eigen::Isometry3d& plane_pose, const Convex& b, const Eigen::Isometry3d& pose_b,
                double reach_m, std::vector<PointPair>& out);

}  // namespace tactus::sim::gaps
