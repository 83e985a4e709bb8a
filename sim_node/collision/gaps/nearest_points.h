// The nearest points of two convex cores, by the method of Gilbert, Johnson and Keerthi 1988. Pure.
#pragma once

#include "sim_node/collision/gaps/convex.h"

namespace tactus::sim::gaps {

enum class Apart { kFar, kNear, kTouching };

struct NearestPoints {
  Eigen::Vector3d on_a, on_b;  // of the cores, in the frame of a
  double distance_m = 0;
};

// kFar: the cores are further apart than the reach. kNear: `out` is filled in. kTouching: they overlap, or are
// nearer than kTouching_m, where the difference of two points has no direction that could be trusted.
inline constexpr double kTouching_m = 1e-7;
Apart nearest_points(const Convex& a, const Convex& b, const Eigen::Isometry3d& a_from_b, double reach_m,
                     NearestPoints& out);

}  // namespace tactus::sim::gaps
