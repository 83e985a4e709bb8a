// The last check before a thermal display: from received commands to a target that its plate may be brought to. It
// keeps its own limits for any content of THERMAL_STATE: range, slew, duration of warmth and cold, age, one
// sender. A driver in C++ uses it as it is; display_program.cpp shows the loop. Pure.
//
//   guard.receive(message, arrival);                               // each THERMAL_STATE
//   const GuardedTarget t = guard.step(plate_degC, now);           // 10 Hz or more
//   if (t.off) switch_off(); else bring_plate_to(t.target_degC);
#pragma once

#include <cstdint>
#include <optional>
#include <tactus/thermal_state_t.hpp>

#include "thermal_node/devices/dated_sender.h"
#include "thermal_node/devices/device.h"
#include "thermal_node/display/controller.h"
#include "thermal_node/settings.gen.h"
#include "thermal_node/skin/dwell.h"

namespace tactus::thermal {

struct GuardedTarget {
  double target_degC = 33;        // always finite and within the limits
  double load_W = 0;              // estimated heat from the finger, finite
  bool limited = false;           // the command is beyond a limit, or not used
  bool off = false;               // no current may flow: the plate runs away, or its sensor has failed
  const char* problem = nullptr;  // one sentence for the user; null: none
};

class DisplayGuard {
 public:
  // A plate that is hotter than PlateLimits::plate_max_degC by more than this is switched off, and one that is
  // colder than plate_min_degC and becomes colder still. Design: an overshoot is smaller.
  static constexpr double kRunaway_K = 2;
  // Largest heat of a finger; also a bound of the estimate. Design: 20 kW/m^2 on 1 cm^2.
  static constexpr double kMaxLoad_W = 2;

  // settings: the limits are temperature_min, temperature_max, slew_max, dose_max, cold_below and cold_max, the
  // neutral temperature is skin_rest. tool, run_id: commands of others are ignored. clock: id of the clock of this
  // process.
  DisplayGuard(const Settings& settings, int tool, std::int64_t run_id, std::int32_t clock);

  void receive(const thermal_state_t& command, sync::HostTime arrival);
  // plate_degC: measured, mean since the last step; empty: the display has no sensor, and the target counts. Not
  // finite: the sensor has failed. Realtime-safe: yes.
  GuardedTarget step(std::optional<double> plate_degC, sync::HostTime now);

  bool has_command() const { return sender_.followed() > 0; }
  // The exposure of the person, to store and to continue with after a restart.
  const Dwell& dwell() const { return dwell_; }
  void resume(const DwellAccount& before) { dwell_.resume(before); }
  // As it will be if the display stays as it is for this time.
  DwellAccount account_after(double seconds) const;

 private:
  const char* problem(sync::HostTime now) const;
  bool runs_away(double plate_degC) const;

  Settings settings_;
  double neutral_degC_;
  int tool_;
  DatedSender sender_;
  thermal_state_t command_{};
  Dwell dwell_;
  Controller controller_;
  double target_degC_;
  double plate_degC_;
  Exposure exposure_;
  std::optional<sync::HostTime> stepped_;
};

}  // namespace tactus::thermal
