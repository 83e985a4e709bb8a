#include "thermal_node/skin/dwell.h"

#include <algorithm>
#include <cmath>

namespace tactus::thermal {
namespace {

// Sapareto and Dewey 1984: factor per kelvin, above and below 43 degC.
constexpr double kReference_degC = 43;
constexpr double kAbove = 2, kBelow = 4;

double dose_rate(double degC) {
  return std::pow(degC > kReference_degC ? kAbove : kBelow, std::min(degC, 100.0) - kReference_degC);
}

}  // namespace

TemperatureRange Dwell::step(double degC, double dt_s, const TemperatureRange& wide) {
  if (!(dt_s > 0)) dt_s = 0;
  const bool unknown = std::isnan(degC);
  const double warmest = unknown ? wide.max_degC : degC, coldest = unknown ? wide.min_degC : degC;

  if (warmest > kWarm_degC)
    dose_s_ += dose_rate(warmest) * dt_s;
  else
    dose_s_ *= std::exp(-dt_s / kDecay_s);
  cold_s_ = std::max(0.0, cold_s_ + (coldest < limits_.cold_degC ? dt_s : -dt_s));
  // Bounds the recovery time.
  dose_s_ = std::min(dose_s_, 2 * limits_.dose_max_s);
  cold_s_ = std::min(cold_s_, 2 * limits_.cold_max_s);

  if (dose_s_ >= limits_.dose_max_s) warm_limited_ = true;
  if (dose_s_ <= limits_.dose_max_s / 2) warm_limited_ = false;
  if (cold_s_ >= limits_.cold_max_s) cold_limited_ = true;
  if (cold_s_ <= limits_.cold_max_s / 2) cold_limited_ = false;
  return {cold_limited_ ? std::max(wide.min_degC, limits_.cold_degC) : wide.min_degC,
          warm_limited_ ? std::min(wide.max_degC, kWarm_degC) : wide.max_degC};
}

void Dwell::resume(const Dwell& before) {
  dose_s_ = before.dose_s_;
  cold_s_ = before.cold_s_;
  warm_limited_ = before.warm_limited_;
  cold_limited_ = before.cold_limited_;
}

}  // namespace tactus::thermal
