// A device that another program drives, in any language with LCM: the program sends device_state_t and receives
// device_force_t. Its messages may be late, missing or contradictory; the device is then lost until they are valid
// again.
#pragma once

#include <string>
#include <tactus/device_force_t.hpp>
#include <tactus/device_state_t.hpp>

#include "haptic_node/devices/device.h"
#include "haptic_node/devices/device_timing.h"
#include "haptic_node/devices/state_stream.h"

namespace tactus::haptic {

struct ExternalDef {
  double stale_after_s = 0.05;    // silence after which it is lost, and duration of valid states before its return
  double unknown_delay_s = 0.002;  // transit assumed for a driver whose clock is not known
  bool at_once = false;           // the driver applies a force on arrival instead of with its next state
};

class External : public Device {
 public:
  static constexpr double kMaxSpeed_m_s = StateStream::kMaxSpeed_m_s;

  // offset_m: of the frame of the device in the world.
  External(std::string name, const Eigen::Vector3d& offset_m, const ExternalDef& def);
  External(std::string name, const Eigen::Vector3d& offset_m, double stale_after_s)
      : External(std::move(name), offset_m, ExternalDef{.stale_after_s = stale_after_s}) {}

  void set_clock(const sync::OwnClock& own) override { stream_.set_clock(own); }
  // Uses the newest state with this name, from one program; contradictory ones lose the device (state_stream.h).
  void on_message(const device_state_t& state, sync::HostTime arrival) override;
  // Force command of another process. Two processes that hold one device would shake it between their forces: the
  // device is lost for both while this lasts.
  void on_message(const device_force_t& others, sync::HostTime arrival) override;
  DeviceState read(sync::HostTime now) override;
  std::string problem(sync::HostTime now) const override;
  using Device::write;
  void write(const Wrench& wrench) override;
  device_force_t* force_message() override { return &force_; }

  const StateStream& stream() const { return stream_; }

 private:
  bool lost(sync::HostTime now) const;
  void accept_newest();

  std::string name_;
  Eigen::Vector3d offset_m_;
  StateStream stream_;
  DeviceTiming timing_;
  DeviceState accepted_;
  device_force_t force_{};
};

}  // namespace tactus::haptic
