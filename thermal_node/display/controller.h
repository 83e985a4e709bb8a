// Turns a wanted skin temperature into a command that a Peltier element may give to skin: within the skin-safe
// range, no faster than the element, whatever is asked.
#pragma once

namespace tactus::thermal {

struct ControllerLimits {
  double min_degC = 15;
  double max_degC = 42;
  double slew_K_s = 20;
};

struct Command {
  double command_degC = 0;
  bool limited = false;  // cut to the range
};

// Realtime-safe: yes.
class Controller {
 public:
  // start_degC: where the element stands, cut to the range.
  Controller(const ControllerLimits& limits, double start_degC);

  // Limits may change at run time; the next command obeys them.
  void set_limits(const ControllerLimits& limits) { limits_ = limits; }

  // A wish that is no number keeps the command where it is. The range comes before the slew limit: when a range is
  // narrowed, the command is inside at once.
  Command step(double wanted_degC, double dt_s);

 private:
  ControllerLimits limits_;
  double command_degC_;
};

}  // namespace tactus::thermal
