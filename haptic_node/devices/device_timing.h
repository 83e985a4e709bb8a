// Measures the timing of an external device from the stamps of its states and their arrivals: interval, transit, and
// the delay from a state to the effect of the force that is computed from it. Pure.
//
// The way of the force cannot be measured here, because a driver does not report it. It is assumed to take as long as
// the way of the state. A driver that applies forces once per state (examples/device_driver) applies a force at the
// first state after its arrival. The delay then is a multiple of the interval.
#pragma once

#include <cstdint>

#include "haptic_node/devices/device.h"

namespace tactus::haptic {

class DeviceTiming {
 public:
  // Upper bound of each measured time, s. No stamp can soften touch further (design: a device that is silent for half
  // of this time is lost).
  static constexpr double kMax_s = 0.1;

  // at_once: the driver applies a force on arrival instead of with its next state.
  explicit DeviceTiming(bool at_once) : at_once_(at_once) {}

  // Clears all measurements: another driver, or the same one after a silence.
  void restart();
  // A new state. stamp_ns: its publish time on the clock of the driver; transit_s: from there to its arrival. Values
  // out of range are clamped. Realtime-safe: yes.
  void on_state(std::int64_t stamp_ns, double transit_s, sync::HostTime arrival);
  // Call once per tick. Returns the timing of the newest state. A gap in progress counts as an interval, so the value
  // follows a driver that slows down without waiting for its next state. Realtime-safe: yes.
  DeviceLoop step(sync::HostTime now);

 private:
  void measure_use(sync::HostTime now);

  bool at_once_;
  bool known_ = false, fresh_ = false;
  std::int64_t stamp_ns_ = 0, used_stamp_ns_ = 0;  // of the newest state, and of the one used before it
  bool used_ = false;
  sync::HostTime arrival_{}, measured_{}, last_step_{};
  double transit_s_ = 0;                         // mean
  double interval_s_ = 0, last_interval_s_ = 0;  // mean and newest; 0: not known
  double longest_interval_s_ = 0, delay_s_ = 0;  // recent peaks
};

}  // namespace tactus::haptic
