// Rotation vectors: the direction is the axis, the length is the angle.
#pragma once

#include <Eigen/Geometry>
#include <cmath>

namespace tactus::haptic {

// Rotation vector of a quaternion, at most half a revolution, rad.
inline Eigen::Vector3d rotation_vector(const Eigen::Quaterniond& q) {
  const double sine = q.vec().norm();
  if (sine < 1e-12) return (q.w() < 0 ? -2 : 2) * q.vec();
  const double half = std::atan2(sine, std::abs(q.w()));
  return (q.w() < 0 ? -2 : 2) * half / sine * q.vec();
}

// Rotation from `from` to `to`, in world axes, rad.
inline Eigen::Vector3d rotation_between(const Eigen::Quaterniond& from, const Eigen::Quaterniond& to) {
  return rotation_vector(to * from.conjugate());
}

// Rotates `q` in world axes.
inline Eigen::Quaterniond rotated_by(const Eigen::Vector3d& rotation_rad, const Eigen::Quaterniond& q) {
  const double angle = rotation_rad.norm();
  if (angle < 1e-300) return q;
  return (Eigen::Quaterniond(Eigen::AngleAxisd(angle, rotation_rad / angle)) * q).normalized();
}

}  // namespace tactus::haptic
