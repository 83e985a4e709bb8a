// The hand of a recorded run: its pose comes from the log, and it ignores the force.
#pragma once

#include "haptic_node/devices/device.h"

namespace tactus::haptic {

class RecordedHand final : public Device {
 public:
  // at: state in the current tick; outlives this.
  explicit RecordedHand(const DeviceState& at) : at_(at) {}
  DeviceState read(sync::HostTime) override { return at_; }
  using Device::write;
  void write(const Wrench&) override {}

 private:
  const DeviceState& at_;
};

}  // namespace tactus::haptic
