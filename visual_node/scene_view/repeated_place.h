// A place near the eye at which the maps of a far body look as at its origin. Pure.
#pragma once

#include <Eigen/Geometry>
#include <cmath>

#include "visual_node/lens/camera.h"

namespace tactus::visual {

// The shortest length that is a multiple of both lengths, m; 0: none below 64 of the first.
inline double common_multiple_m(double u_m, double v_m) {
  if (!(u_m > 0) || !(v_m > 0)) return 0;
  for (int k = 1; k <= 64; ++k)
    if (const double times = k * u_m / v_m; times > 0.5 && std::abs(times - std::round(times)) < 1e-9 * times) return k * u_m;
  return 0;
}

// A map repeats along each axis of its body: it looks the same from the origin of the body and from a place that is whole
// repetitions away. Returns such a place, m, world, nearest to origin_m; the origin of the body itself when it is nearer than a cell of
// the grid of origins, or when the lengths of one repetition along u and v have no common multiple.
inline Eigen::Vector3d repeated_place(const Eigen::Vector2d& repetition_m, const Eigen::Isometry3d& body, const Eigen::Vector3d& origin_m) {
  const Eigen::Vector3d away_m = body.linear().transpose() * (origin_m - body.translation());
  const double length_m = away_m.norm() > kOriginGrid_m ? common_multiple_m(repetition_m.x(), repetition_m.y()) : 0;
  if (!(length_m > 0)) return body.translation();
  const Eigen::Vector3d whole = (length_m * (away_m / length_m).array().round()).matrix();
  return body.translation() + body.linear() * whole;
}

}  // namespace tactus::visual
