#include "thermal_node/display/controller.h"

#include <algorithm>
#include <cmath>

namespace tactus::thermal {

Controller::Controller(const ControllerLimits& limits, double start_degC)
    : limits_(limits), command_degC_(std::clamp(start_degC, limits.min_degC, limits.max_degC)) {}

Command Controller::step(double wanted_degC, double dt_s) {
  if (std::isnan(wanted_degC)) wanted_degC = command_degC_;
  const double target = std::clamp(wanted_degC, limits_.min_degC, limits_.max_degC);
  const double max_step = dt_s > 0 ? limits_.slew_K_s * dt_s : 0;
  const double stepped = command_degC_ + std::clamp(target - command_degC_, -max_step, max_step);
  command_degC_ = std::clamp(stepped, limits_.min_degC, limits_.max_degC);
  return {command_degC_, target != wanted_degC};
}

}  // namespace tactus::thermal
