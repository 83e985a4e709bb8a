// A hand of mathematics: a mass that a spring and a damper pull along a path, so that contact pushes it back; and
// an inertia that they hold in the orientation of its rest, so that torque turns it.
#pragma once

#include <optional>

#include "haptic_node/devices/device.h"
#include "haptic_node/devices/monotone_cubic.h"

namespace tactus::haptic {

struct HandImpedance {
  double mass_kg = 0.1;
  double damping_N_s_m = 10;
  double stiffness_N_m = 300;
  // Of turning.
  double inertia_kg_m2 = 0.0003;
  double turn_damping_N_m_s = 0.03;
  double turn_stiffness_N_m = 1;  // a radian
};

class VirtualHand : public Device {
 public:
  // loop: begins again at its first point after its last; `path` should end where it begins.
  // rest: how it is held where nothing turns it.
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
  std::optional<sync::HostTime> begin_;  // of the path
  bool read_ = false;
  sync::HostTime last_{};
  MonotoneCubic::At target_{};  // where the path was at last_
  Eigen::Vector3d position_ = Eigen::Vector3d::Zero(), velocity_ = Eigen::Vector3d::Zero();
  // Away from its rest, as a rotation vector: exact for turns about one axis, near enough for those that a wrist
  // makes.
  Eigen::Quaterniond rest_;
  Eigen::Vector3d turn_ = Eigen::Vector3d::Zero(), spin_ = Eigen::Vector3d::Zero();
  Wrench felt_;
};

}  // namespace tactus::haptic
