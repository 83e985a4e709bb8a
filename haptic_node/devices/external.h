// A device that another program drives, in any language with LCM: the program sends device_state_t and receives
// device_force_t. Its messages may be late, missing or contradictory; the device is then lost until they are valid
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
  // Faster than any hand: a pose that jumps faster contradicts the previous one (design: twice the highest speed
  // of a hand in a device).
  static constexpr double kMaxSpeed_m_s = 20;

  // offset_m: of the frame of the device in the world. stale_after_s: silence after which it is lost, and duration
  // of valid messages before it is accepted again.
  External(std::string name, const Eigen::Vector3d& offset_m, double stale_after_s);

  // Uses the newest state with this name, from one program. Two programs that send at the same time, or a pose
  // that jumps, are contradictions.
  void on_message(const device_state_t& state, sync::HostTime arrival) override;
  // Force command of another process. Two processes that hold one device would shake it between their forces: the
  // device is lost for both while this lasts.
  void on_message(const device_force_t& others, sync::HostTime arrival) override;
  DeviceState read(sync::HostTime now) override;
  using Device::write;
  void write(const Wrench& wrench) override;
  device_force_t* force_message() override { return &force_; }

 private:
  bool lost(sync::HostTime now) const;

  std::string name_;
  Eigen::Vector3d offset_m_;
  sync::Nanoseconds stale_after_;
  std::optional<device_state_t> newest_;
  sync::HostTime newest_arrival_{};                   // its arrival
  std::optional<sync::HostTime> last_contradiction_;  // time of the last contradiction
  DeviceState accepted_;
  device_force_t force_{};
};

}  // namespace tactus::haptic
