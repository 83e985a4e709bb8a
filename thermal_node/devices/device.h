// A thermal display under a finger: a command for its plate in, what its sensors say out. Pure: time is an
// argument.
#pragma once

#include <optional>
#include <tactus/thermal_device_t.hpp>

#include "sync/time/time.h"

namespace tactus::thermal {

struct PlateReading {
  double plate_degC = 0;  // mean since the last reading
  double sink_degC = 0;
  double current_A = 0;
  double voltage_V = 0;
  bool limited = false;  // gives less than was commanded
  bool fault = false;    // does not follow
};

class Device {
 public:
  // A display that is not heard for so long is no longer reckoned with, and one that hears no command for so long
  // goes back to neutral: 15 ticks of 20 ms.
  static constexpr sync::Nanoseconds kSilence{300'000'000};

  virtual ~Device() = default;
  // What a program that drives a display says of it.
  virtual void receive(const thermal_device_t&, sync::HostTime /*arrival*/) {}
  // Whether its readings are this process's own, to be told to others.
  virtual bool simulated() const { return false; }
  // Once a tick: the plate's temperature to come to, the heat that the finger is thought to give to it, W; answers
  // what is known of it since the last tick; nothing while it is silent.
  virtual std::optional<PlateReading> step(double command_degC, double load_W, sync::HostTime now) = 0;
};

}  // namespace tactus::thermal
