// A hand of mathematics: a mass that a spring and a damper pull along a path, so that contact pushes it back.
#pragma once

#include "haptic_node/devices/device.h"
#include "haptic_node/devices/monotone_cubic.h"

namespace tactus::haptic {

struct HandImpedance {
  double mass_kg = 0.1;
  double damping_N_s_m = 10;
  double stiffness_N_m = 300;
};

class VirtualHand : public Device {
 public:
  // loop: begins again at its first point after its last; `path` should end where it begins.
  VirtualHand(MonotoneCubic path, bool loop, const HandImpedance& hand);

  // The path begins at the first read.
  DeviceState read(sync::HostTime now) override;
  void write(const Eigen::Vector3d& force_N) override { force_ = force_N; }

 private:
  MonotoneCubic::At target(sync::HostTime now) const;
  void advance(const MonotoneCubic::At& to, const Eigen::Vector3d& force_N, double dt);

  MonotoneCubic path_;
  bool loop_;
  HandImpedance hand_;
  bool begun_ = false;
  sync::HostTime start_{}, last_{};
  MonotoneCubic::At target_{};  // where the path was at last_
  Eigen::Vector3d position_ = Eigen::Vector3d::Zero(), velocity_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d force_ = Eigen::Vector3d::Zero();
};

}  // namespace tactus::haptic
