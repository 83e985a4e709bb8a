// Nearest points of two convex cores by the GJK algorithm (Gilbert, Johnson and Keerthi 1988). Pure.
#pragma once

#include "sim_node/collision/gaps/convex.h"

namespace tactus::sim::gaps {

enum class Proximity { kFar, kNear, kTouching };

struct NearestPoints {
  Eigen::Vector3d on_a, on_b;  // on the cores, in the frame of a
  double distance_m = 0;
};

// kFar: the cores are further apart than the reach. kNear: `out` is filled. kTouching: they overlap, or are nearer
// than kTouching_m, where the difference of the two points has no reliable direction.
inline constexpr double kTouching_m = 1e-7;
Proximity nearest_points(const Convex& a, const Convex& b, const Eigen::Isometry3d& a_from_b, double reach_m,
                     NearestPoints& out);

}  // namespace tactus::sim::gaps
