// A string-driven device: pose from the lengths of its strings, force by tensions that are never negative.
#pragma once

#include <memory>

#include "haptic_node/devices/device.h"
#include "haptic_node/devices/spidar/string_motors.h"
#include "haptic_node/devices/spidar/string_pose.h"
#include "haptic_node/devices/spidar/tensions.h"
#include "haptic_node/devices/spidar/window_velocity.h"

namespace tactus::haptic {

// Outside the workspace the force fades to zero over this share of its radius, and every string goes to its
// minimum tension, because the strings no longer pull in all directions there (design: a tenth feels like an edge,
// not like a blow).
inline constexpr double kEdgeShare = 0.1;
// Root mean square error of the lengths above which the device is lost: a string is broken, tangled or slack
// (design: ten times the effect of counts and of the sag of a string at minimum tension).
inline constexpr double kLostResidual_m = 0.01;

class Spidar : public Device {
 public:
  // origin_m: of the frame in the world, with the axes of the world. Throws the errors of check_frame.
  Spidar(StringFrame frame, const Eigen::Vector3d& origin_m, std::unique_ptr<StringMotors> motors);

  void begin(sync::HostTime at) override { motors_->begin(at); }
  // The pose follows the strings also outside the workspace. While no pose fits the lengths, the last valid pose
  // stays and the device is lost.
  DeviceState read(sync::HostTime now) override;
  using Device::write;
  // With four strings the torque is ignored. Realtime-safe: yes, as read().
  void write(const Wrench& wanted) override;

  // Tensions of the last written force, its error and the reason.
  const Tensions& tensions() const { return tensions_; }
  // 1 inside the workspace, 0 beyond its edge.
  double workspace_factor() const;

 private:
  StringFrame frame_;
  Eigen::Vector3d origin_m_;
  std::unique_ptr<StringMotors> motors_;
  PerString middle_m_;
  WindowVelocity velocity_;
  WindowVelocity spin_;
  Eigen::Vector3d turned_rad_ = Eigen::Vector3d::Zero();  // sum of all small rotations so far
  SolvedPose solved_;
  GripPose pose_;  // the last pose that fitted the strings
  Tensions tensions_;
  bool lost_ = false;
};

}  // namespace tactus::haptic
