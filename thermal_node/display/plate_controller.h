// The current that brings a Peltier plate to a wanted temperature, within limits of current, voltage, rate and
// temperature, for any input.
#pragma once

#include "thermal_node/display/peltier.h"

namespace tactus::thermal {

struct PlateLimits {
  // 0.7 of the current at the largest difference: makers advise 70 to 80 % (thermoelectric-generator.com,
  // glossary, Imax).
  double current_A = 0.7 * kTm31_14_85.current_max_A;
  double voltage_V = kTm31_14_85.voltage_max_V;
  double rate_K_s = 20;
  double plate_min_degC = 10;
  double plate_max_degC = 43;
  double sink_max_degC = 55;  // design: far below the solder of the module, and no hand rests on it
};

struct PlateDrive {
  double current_A = 0;
  bool limited = false;  // less than requested
  bool fault = false;    // plate, sink or reading beyond the limits: the current may only lead back within them
};

// Feed-forward from the equations of the module (load, conduction, requested rate), with proportional and integral
// feedback. Runs at 1 kHz together with the module. Realtime-safe: yes.
class PlateController {
 public:
  PlateController(const PeltierPlant& plant, const PlateLimits& limits) : plant_(plant), limits_(limits) {}

  // measured: sensors of plate and sink. wanted_degC: clamped to the limits; not finite: the current is 0. load_W:
  // estimated heat from the skin to the plate; 0 when not known.
  PlateDrive step(const PeltierState& measured, double wanted_degC, double load_W, double dt_s);

 private:
  PeltierPlant plant_;
  PlateLimits limits_;
  double integral_W_ = 0;
};

}  // namespace tactus::thermal
