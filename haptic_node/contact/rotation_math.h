// Turns as rotation vectors: their direction is the axis, their length the angle.
#pragma once

#include <Eigen/Geometry>
#include <cmath>

namespace tactus::haptic {

// The turn that a rotation is, at most half a circle, rad.
inline Eigen::Vector3d rotation_vector(const Eigen::Quaterniond& q) {
  const double sine = q.vec().norm();
  if (sine < 1e-12) return (q.w() < 0 ? -2 : 2) * q.vec();
  const double half = std::atan2(sine, std::abs(q.w()));
  return (q.w() < 0 ? -2 : 2) * half / sine * q.vec();
}

// In world axes, the turn that brings `from` to `to`, rad.
inline Eigen::Vector3d turn_between(const Eigen::Quaterniond& from, const Eigen::Quaterniond& to) {
  return rotation_vector(to * from.conjugate());
}

// `q` after a turn in world axes.
inline Eigen::Quaterniond turned_by(const Eigen::Vector3d& turn_rad, const Eigen::Quaterniond& q) {
  const double angle = turn_rad.norm();
  if (angle < 1e-300) return q;
  return (Eigen::Quaterniond(Eigen::AngleAxisd(angle, turn_rad / angle)) * q).normalized();
}

}  // namespace tactus::haptic
