#include "thermal_node/display/peltier.h"

#include <cmath>

namespace tactus::thermal {
namespace {

constexpr double kZero_K = 273.15;

// K/s
struct Rates {
  double plate, sink;
};

Rates rates(const PeltierPlant& p, const PeltierState& s, double current_A, double load_W) {
  const double from_plate = pumped_W(p.module, s, current_A);
  const double into_sink = from_plate + current_A * voltage_V(p.module, s, current_A);
  const double to_room = (s.sink_degC - p.room_degC) / p.sink_to_room_K_W;
  return {(load_W - from_plate) / p.plate_J_K, (into_sink - to_room) / p.sink_J_K};
}

}  // namespace

PeltierModule PeltierModule::from(const PeltierDataSheet& d) {
  const double cold_K = d.hot_K - d.temperature_difference_K;
  return {d.voltage_max_V / d.hot_K, d.voltage_max_V * cold_K / (d.current_max_A * d.hot_K),
          d.voltage_max_V * d.current_max_A * cold_K / (2 * d.hot_K * d.temperature_difference_K)};
}

double pumped_W(const PeltierModule& m, const PeltierState& s, double current_A) {
  return m.seebeck_V_K * current_A * (s.plate_degC + kZero_K) - 0.5 * current_A * current_A * m.resistance_ohm -
         m.conductance_W_K * (s.sink_degC - s.plate_degC);
}

double current_for_A(const PeltierModule& m, const PeltierState& s, double pumped_W) {
  // R/2 I^2 - S T I + (pumped + K (T_s - T_p)) = 0, the smaller root: the larger one dissipates more for the same
  // result.
  const double peltier = m.seebeck_V_K * (s.plate_degC + kZero_K);
  const double wanted = pumped_W + m.conductance_W_K * (s.sink_degC - s.plate_degC);
  const double under = peltier * peltier - 2 * m.resistance_ohm * wanted;
  return under > 0 ? (peltier - std::sqrt(under)) / m.resistance_ohm : peltier / m.resistance_ohm;
}

double voltage_V(const PeltierModule& m, const PeltierState& s, double current_A) {
  return m.seebeck_V_K * (s.sink_degC - s.plate_degC) + current_A * m.resistance_ohm;
}

PeltierState step(const PeltierPlant& p, const PeltierState& s, double current_A, double load_W, double dt_s) {
  const Rates begin = rates(p, s, current_A, load_W);
  const PeltierState middle{s.plate_degC + begin.plate * dt_s / 2, s.sink_degC + begin.sink * dt_s / 2};
  const Rates r = rates(p, middle, current_A, load_W);
  return {s.plate_degC + r.plate * dt_s, s.sink_degC + r.sink * dt_s};
}

}  // namespace tactus::thermal
