// Interface of a thermal display under a finger: plate command in, sensor readings out. Pure: time is an argument.
#pragma once

#include <cstdint>
#include <optional>
#include <tactus/thermal_device_t.hpp>

#include "sync/time/time.h"

namespace tactus::thermal {

struct PlateReading {
  double plate_degC = 0;  // mean since the last reading
  double sink_degC = 0;
  double current_A = 0;
  double voltage_V = 0;
  bool limited = false;  // gives less than the command
  bool fault = false;    // does not follow the command
};

class Device {
 public:
  // After this silence the readings of a display are no longer used, and a display without commands returns to
  // neutral: 15 ticks of 20 ms.
  static constexpr sync::Nanoseconds kSilence{300'000'000};

  virtual ~Device() = default;
  // Reading of a display that another program drives.
  virtual void receive(const thermal_device_t&, sync::HostTime /*arrival*/) {}
  // True when the readings belong to this process, which then publishes them.
  virtual bool simulated() const { return false; }
  // Call once per tick. command_degC: target of the plate; load_W: estimated heat from the finger, W. Returns the
  // reading since the last tick; empty while the display is silent.
  virtual std::optional<PlateReading> step(double command_degC, double load_W, sync::HostTime now) = 0;
  // Reason why the display cannot be relied on, one sentence; null: none.
  virtual const char* problem(sync::HostTime /*now*/) const { return nullptr; }
  // Number of displays so far; another one begins when it changes.
  virtual std::int64_t displays() const { return 1; }
  // Slowest return of the plate to neutral. Design: half of the rate of the default element.
  virtual double return_K_s() const { return 10; }
};

}  // namespace tactus::thermal
