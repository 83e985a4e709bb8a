// A simulated hand. A spring and a damper pull its mass along a path, and a contact can push it back. A second
// spring and damper hold its inertia in a rest orientation, and a torque can turn it.
#pragma once

#include <optional>

#include "haptic_node/devices/device.h"
#include "haptic_node/devices/monotone_cubic.h"

namespace tactus::haptic {

struct HandImpedance {
  double mass_kg = 0.1;
  double damping_N_s_m = 10;
  double stiffness_N_m = 300;
  // Values of the rotation.
  double inertia_kg_m2 = 0.0003;
  double turn_damping_N_m_s = 0.03;
  double turn_stiffness_N_m = 1;  // N m per radian
};

class VirtualHand : public Device {
 public:
  // loop: restarts at the first point after the last; `path` should end where it begins. rest: orientation without
  // torque.
  VirtualHand(MonotoneCubic path, bool loop, const HandImpedance& hand,
              const Eigen::Quaterniond& rest = Eigen::Quaterniond::Identity());

  void begin(sync::HostTime at) override { begin_ = at; }
  DeviceState read(sync::HostTime now) override;
  using Device::write;
  void write(const Wrench& wrench) override { felt_ = wrench; }

 private:
  MonotoneCubic::At target(sync::HostTime now) const;
  void advance(const MonotoneCubic::At& to, double dt);

  MonotoneCubic path_;
  bool loop_;
  HandImpedance hand_;
  std::optional<sync::HostTime> begin_;  // start of the path
  bool read_ = false;
  sync::HostTime last_{};
  MonotoneCubic::At target_{};  // point of the path at the time last_
  Eigen::Vector3d position_ = Eigen::Vector3d::Zero(), velocity_ = Eigen::Vector3d::Zero();
  // Rotation from rest_ as a rotation vector: exact for rotations about one axis, accurate enough for those of a
  // wrist.
  Eigen::Quaterniond rest_;
  Eigen::Vector3d rotation_ = Eigen::Vector3d::Zero(), spin_ = Eigen::Vector3d::Zero();
  Wrench felt_;
};

}  // namespace tactus::haptic
