#include "thermal_node/devices/simulated_peltier.h"

#include <algorithm>
#include <cmath>

namespace tactus::thermal {
namespace {

constexpr double kStep_s = 0.001;
// Upper bound of one step, also after a long stop of the process.
constexpr double kMaxTime_s = 1;

}  // namespace

std::optional<PlateReading> SimulatedPeltier::step(double command_degC, double load_W, sync::HostTime now) {
  const double dt_s = std::clamp(sync::to_seconds(now - now_.value_or(now)), 0.0, kMaxTime_s);
  now_ = now;
  const int steps = static_cast<int>(std::ceil(dt_s / kStep_s));
  const double load = std::isfinite(load_W) ? load_W : 0;
  PlateReading r{state_.plate_degC, state_.sink_degC};
  double sum = 0;
  for (int i = 0; i < steps; ++i) {
    const double h_s = dt_s / steps;
    const PlateDrive drive = controller_.step(state_, command_degC, load, h_s);
    r.current_A = drive.current_A;
    r.voltage_V = voltage_V(plant_.module, state_, drive.current_A);
    r.limited = drive.limited;
    r.fault = drive.fault;
    const double before = state_.plate_degC;
    state_ = thermal::step(plant_, state_, drive.current_A, load, h_s);
    sum += (before + state_.plate_degC) / 2;
  }
  if (steps > 0) r.plate_degC = sum / steps;
  r.sink_degC = state_.sink_degC;
  return r;
}

}  // namespace tactus::thermal
