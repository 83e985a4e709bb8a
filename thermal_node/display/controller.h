// Converts a wanted skin temperature into a safe command for a Peltier element: within the skin-safe range and the
// slew limit, for any input.
#pragma once

namespace tactus::thermal {

struct ControllerLimits {
  double min_degC = 15;
  double max_degC = 42;
  double slew_K_s = 20;
};

// Largest swing of a plate about a constant command, under a load that is not known: see
// plate_controller_test.cpp.
inline constexpr double kPlateSwing_K = 0.3;

struct Command {
  double command_degC = 0;
  bool limited = false;  // clamped to the range
};

// Realtime-safe: yes.
class Controller {
 public:
  // start_degC: current temperature of the element, clamped to the range.
  Controller(const ControllerLimits& limits, double start_degC);

  // Limits may change at run time; the next command obeys them.
  void set_limits(const ControllerLimits& limits) { limits_ = limits; }

  // NaN keeps the current command. The range has priority over the slew limit: when a range is narrowed, the
  // command is inside immediately.
  Command step(double wanted_degC, double dt_s);

 private:
  ControllerLimits limits_;
  double command_degC_;
};

}  // namespace tactus::thermal
