#include "sync/degradation/quantise.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tactus::sync {

double quantised(const QuantiseDef& def, double value) {
  if (def.ratio == 0) return def.step > 0 ? std::round(value / def.step) * def.step : value;
  const double size = std::abs(value);
  if (size < def.floor / std::sqrt(def.ratio)) return 0;
  const double level = std::max(0.0, std::round(std::log(size / def.floor) / std::log(def.ratio)));
  return std::copysign(def.floor * std::pow(def.ratio, level), value);
}

double lowpassed(double before, double value, double cutoff_Hz, double dt_s) {
  return before + (1 - std::exp(-2 * std::numbers::pi * cutoff_Hz * dt_s)) * (value - before);
}

}  // namespace tactus::sync
