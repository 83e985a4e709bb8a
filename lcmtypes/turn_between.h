// The shortest turn from one direction to another.
#pragma once

#include <Eigen/Geometry>

namespace tactus {

// The rotation that maps the direction `from` to the direction `to`. Neither is zero; their lengths do not matter. Opposite
// directions need half a turn about any axis that is perpendicular to both.
// It stands in a file of its own, because Eigen computes this axis by a singular value decomposition, which takes seconds to compile.
Eigen::Quaterniond turn_between(const Eigen::Vector3d& from, const Eigen::Vector3d& to);

}  // namespace tactus
