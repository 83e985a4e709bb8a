// Pose and velocity of a body, as the solver outputs them. Plain data, world frame, SI.
#pragma once

#include <Eigen/Geometry>

namespace tactus::sim {

struct BodyMotion {
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();  // of the body frame
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
  Eigen::Vector3d centre_m = Eigen::Vector3d::Zero();  // of mass
  Eigen::Vector3d velocity_m_s = Eigen::Vector3d::Zero();  // of the centre of mass
  Eigen::Vector3d spin_rad_s = Eigen::Vector3d::Zero();
  double inverse_mass_1_kg = 0;  // 0: does not move
  Eigen::Matrix3d inverse_inertia = Eigen::Matrix3d::Zero();  // 1/(kg m^2), about the centre of mass, world axes

  Eigen::Vector3d velocity_at(const Eigen::Vector3d& point) const {
    return velocity_m_s + spin_rad_s.cross(point - centre_m);
  }
  Eigen::Vector3d to_world(const Eigen::Vector3d& in_body) const { return position_m + orientation * in_body; }
  Eigen::Vector3d to_body(const Eigen::Vector3d& in_world) const {
    return orientation.conjugate() * (in_world - position_m);
  }
  bool moves() const { return inverse_mass_1_kg > 0; }
};

// Speed of the point along n per unit impulse along n at the point, 1/kg.
inline double mobility(const BodyMotion& b, const Eigen::Vector3d& point, const Eigen::Vector3d& n) {
  if (!b.moves()) return 0;
  const Eigen::Vector3d arm = (point - b.centre_m).cross(n);
  return b.inverse_mass_1_kg + arm.dot(b.inverse_inertia * arm);
}

}  // namespace tactus::sim
