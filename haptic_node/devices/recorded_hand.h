// The hand of a run that is over: it is where the log says, and feels nothing any more.
#pragma once

#include "haptic_node/devices/device.h"

namespace tactus::haptic {

class RecordedHand final : public Device {
 public:
  // at: where it is in the present tick; outlives this.
  explicit RecordedHand(const DeviceState& at) : at_(at) {}
  DeviceState read(sync::HostTime) override { return at_; }
  using Device::write;
  void write(const Wrench&) override {}

 private:
  const DeviceState& at_;
};

}  // namespace tactus::haptic
