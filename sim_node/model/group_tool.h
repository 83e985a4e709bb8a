// State of a tool for the groups of a dual simulation. Plain data.
#pragma once

#include <Eigen/Core>

namespace tactus::sim {

struct GroupTool {
  Eigen::Vector3d centre_m = Eigen::Vector3d::Zero(), velocity_m_s = Eigen::Vector3d::Zero();
  double radius_m = 0;
};

}  // namespace tactus::sim
