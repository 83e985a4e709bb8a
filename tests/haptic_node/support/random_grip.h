// Random poses within the workspace of a string frame.
#pragma once

#include <random>

#include "haptic_node/devices/spidar/string_frame.h"

namespace tactus::haptic::test {

inline Eigen::Vector3d random_direction(std::mt19937& random) {
  std::normal_distribution<double> normal;
  Eigen::Vector3d v;
  do v = {normal(random), normal(random), normal(random)};
  while (v.norm() < 1e-6);
  return v.normalized();
}

inline GripPose random_pose(const StringFrame& f, std::mt19937& random) {
  std::uniform_real_distribution<double> share(0, 1);
  GripPose pose;
  pose.position_m = f.workspace_radius_m * std::cbrt(share(random)) * random_direction(random);
  if (f.has_torque())
    pose.orientation = Eigen::AngleAxisd(f.workspace_tilt_rad * share(random), random_direction(random));
  return pose;
}

}  // namespace tactus::haptic::test
