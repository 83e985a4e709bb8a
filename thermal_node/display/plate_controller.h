// The current that brings a Peltier's plate to a wanted temperature, within the limits of current, voltage, rate
// and temperature, whatever is wanted.
#pragma once

#include "thermal_node/display/peltier.h"

namespace tactus::thermal {

struct PlateLimits {
  // 0.7 of the current that makes the largest difference: makers advise 70 to 80 % (thermoelectric-generator.com,
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
  bool limited = false;  // less than the wish asks for
  bool fault = false;    // plate, sink or reading beyond the limits: no current but the one that leads back
};

// Feed-forward from the module's own equations (load, conduction, the rate asked for), feedback proportional and
// integral. Runs at 1 kHz beside the module. Realtime-safe: yes.
class PlateController {
 public:
  PlateController(const PeltierPlant& plant, const PlateLimits& limits) : plant_(plant), limits_(limits) {}

  // measured: by the sensors of plate and sink. wanted_degC: cut to the limits; no number: the current is 0.
  // load_W: what the skin is thought to give to the plate; 0 when not known.
  PlateDrive step(const PeltierState& measured, double wanted_degC, double load_W, double dt_s);

 private:
  PeltierPlant plant_;
  PlateLimits limits_;
  double integral_W_ = 0;
};

}  // namespace tactus::thermal
