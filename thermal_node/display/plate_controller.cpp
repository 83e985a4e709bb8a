#include "thermal_node/display/plate_controller.h"

#include <algorithm>
#include <cmath>

namespace tactus::thermal {
namespace {

// Design: the plate closes a gap in 30 ms and the remaining model error (load, sensor resistance) in 0.5 s. Both
// are far slower than the controller period of 1 ms and far faster than skin.
constexpr double kClosing_s = 0.03;
constexpr double kIntegral_s = 0.5;
// Bound of the integral: the largest heat of a finger, 20 kW/m^2 on 1 cm^2.
constexpr double kMaxUnknown_W = 2;
// A temperature beyond a limit by more than this is a fault, not an overshoot.
constexpr double kSlack_K = 1;

}  // namespace

PlateDrive PlateController::step(const PeltierState& s, double wanted_degC, double load_W, double dt_s) {
  PlateDrive drive;
  const bool known = std::isfinite(s.plate_degC) && std::isfinite(s.sink_degC) && std::isfinite(wanted_degC);
  if (!known || s.sink_degC > limits_.sink_max_degC) {
    integral_W_ = 0;
    drive.fault = true;
    return drive;
  }
  const double wanted = std::clamp(wanted_degC, limits_.plate_min_degC, limits_.plate_max_degC);
  drive.fault =
      s.plate_degC > limits_.plate_max_degC + kSlack_K || s.plate_degC < limits_.plate_min_degC - kSlack_K;
  if (!std::isfinite(load_W)) load_W = 0;

  const double gap_K = wanted - s.plate_degC;
  const double rate = std::clamp(gap_K / kClosing_s, -limits_.rate_K_s, limits_.rate_K_s);
  const double pump = load_W + integral_W_ - plant_.plate_J_K * rate;
  const double asked = current_for_A(plant_.module, s, pump);

  const double seebeck_V = voltage_V(plant_.module, s, 0), resistance = plant_.module.resistance_ohm;
  const double low = std::max(-limits_.current_A, (-limits_.voltage_V - seebeck_V) / resistance);
  const double high = std::min(limits_.current_A, (limits_.voltage_V - seebeck_V) / resistance);
  drive.current_A = low <= high ? std::clamp(asked, low, high) : 0;
  drive.limited = wanted != wanted_degC || drive.current_A != asked || std::abs(rate) >= limits_.rate_K_s;

  // Anti-windup: integrates only while the plate is free to follow.
  if (!drive.limited && dt_s > 0)
    integral_W_ = std::clamp(integral_W_ - plant_.plate_J_K * gap_K / kClosing_s / kIntegral_s * dt_s,
                             -kMaxUnknown_W, kMaxUnknown_W);
  return drive;
}

}  // namespace tactus::thermal
