// A string-driven device: pose from the lengths of its strings, force as tensions that are never negative.
#pragma once

#include <memory>
#include <optional>

#include "haptic_node/devices/device.h"
#include "haptic_node/devices/spidar/string_motors.h"
#include "haptic_node/devices/spidar/string_pose.h"
#include "haptic_node/devices/spidar/tensions.h"
#include "haptic_node/devices/spidar/window_velocity.h"

namespace tactus::haptic {

// Outside the workspace a wanted force fades to none over this share of its radius, and every string to its least
// tension: there strings no longer pull all ways (design: a tenth, felt as the edge, not as a blow).
inline constexpr double kEdgeShare = 0.1;
// A string that is broken, tangled or hangs through shows as lengths that no pose explains, to the mean square
// (design: ten times what counts and the curve of a string at its least tension explain).
inline constexpr double kLostResidual_m = 0.01;

class Spidar : public Device {
 public:
  // origin_m: of the frame in the world; its axes are the world's. Throws what check_frame does.
  Spidar(StringFrame frame, const Eigen::Vector3d& origin_m, std::unique_ptr<StringMotors> motors);

  void begin(sync::HostTime at) override { motors_->begin(at); }
  // Outside the workspace the pose is what the strings say. While no pose explains them it is the last that did,
  // and the device is lost.
  DeviceState read(sync::HostTime now) override;
  using Device::write;
  // The torque is left out with four strings. Realtime-safe: yes, also the one above.
  void write(const Wrench& wanted) override;

  double residual_m() const { return solved_.residual_m; }
  // How far the last written force is from what the strings give, and why.
  const Tensions& tensions() const { return tensions_; }
  // 1 inside the workspace, 0 beyond its edge.
  double inside() const;

 private:
  StringFrame frame_;
  Eigen::Vector3d origin_m_;
  std::unique_ptr<StringMotors> motors_;
  PerString middle_m_;
  WindowVelocity velocity_;
  WindowVelocity spin_;
  Eigen::Vector3d turned_rad_ = Eigen::Vector3d::Zero();  // all small turns so far
  SolvedPose solved_;
  GripPose pose_;  // the last that explained the strings
  Tensions tensions_;
  bool lost_ = false;
};

}  // namespace tactus::haptic
