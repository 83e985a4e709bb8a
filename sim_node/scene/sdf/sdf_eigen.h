// Conversions from libsdformat's vectors and poses to Eigen's.
#pragma once

#include <Eigen/Geometry>
#include <ignition/math/Color.hh>
#include <ignition/math/Pose3.hh>

namespace tactus::sim {

inline Eigen::Vector3d to_eigen(const ignition::math::Vector3d& v) { return {v.X(), v.Y(), v.Z()}; }
inline Eigen::Vector3d to_eigen(const ignition::math::Color& c) { return {c.R(), c.G(), c.B()}; }
inline Eigen::Isometry3d to_eigen(const ignition::math::Pose3d& p) {
  return Eigen::Translation3d(to_eigen(p.Pos())) *
         Eigen::Quaterniond(p.Rot().W(), p.Rot().X(), p.Rot().Y(), p.Rot().Z()).normalized();
}

}  // namespace tactus::sim
