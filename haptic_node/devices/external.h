// A device that another program drives, in any language that LCM has: it sends device_state_t and receives
// device_force_t. What it says may be late, missing or contradictory: then the device is lost until it makes sense
// again.
#pragma once

#include <optional>
#include <string>
#include <tactus/device_force_t.hpp>
#include <tactus/device_state_t.hpp>

#include "haptic_node/devices/device.h"

namespace tactus::haptic {

class External : public Device {
 public:
  // Faster than any hand: a pose that leaps so contradicts the one before (design: twice what
  // the quickest hand in a device does).
  static constexpr double kFastest_m_s = 20;

  // offset_m: of the device's frame in the world. stale_after_s: silence for which it is lost, and time for which
  // what it says must make sense before it is believed again.
  External(std::string name, const Eigen::Vector3d& offset_m, double stale_after_s);

  // Of the states of this name, the newest of one program counts. Two programs that speak at once, and a pose that
  // leaps, are contradictions.
  void hear(const device_state_t& state, sync::HostTime arrival) override;
  // Of another process. Two that hold one device would shake it from the force of the one to that of the other:
  // for both of them it is lost as long as that lasts.
  void hear(const device_force_t& others, sync::HostTime arrival) override;
  DeviceState read(sync::HostTime now) override;
  using Device::write;
  void write(const Wrench& wrench) override;
  device_force_t* tell() override { return &force_; }

 private:
  bool lost(sync::HostTime now) const;

  std::string name_;
  Eigen::Vector3d offset_m_;
  sync::Nanoseconds stale_after_;
  std::optional<device_state_t> newest_;
  sync::HostTime heard_{};                      // when it arrived
  std::optional<sync::HostTime> contradicted_;  // last
  DeviceState believed_;
  device_force_t force_{};
};

}  // namespace tactus::haptic
