#include "thermal_node/skin/dwell.h"

#include <algorithm>
#include <cmath>

namespace tactus::thermal {
namespace {

// Sapareto and Dewey 1984: factor per kelvin, above and below 43 degC.
constexpr double kReference_degC = 43;
constexpr double kAbove = 2, kBelow = 4;
// Temperatures beyond these count like these, so that all sums stay finite.
constexpr double kHottest_degC = 100, kColdest_degC = -100;

double dose_rate(double degC) {
  return std::pow(degC > kReference_degC ? kAbove : kBelow, std::min(degC, kHottest_degC) - kReference_degC);
}

// The reserve is part of the sum also for the release: with a limit of less than two ways the range stays narrow,
// instead of opening for a tick at a time.
void narrow(bool& limited, double sum_s, double max_s) {
  if (sum_s >= max_s) limited = true;
  if (sum_s <= max_s / 2) limited = false;
}

double usable(double sum_s) { return std::isfinite(sum_s) && sum_s >= 0 ? sum_s : DwellAccount::full().dose_s; }

}  // namespace

DwellAccount DwellAccount::recovered(double seconds) const {
  if (!(seconds > 0)) return *this;
  return {dose_s * std::exp(-seconds / Dwell::kDecay_s), std::max(0.0, cold_s - seconds), warm_limited,
          cold_limited};
}

TemperatureRange Dwell::step(const Exposure& e, double dt_s, const TemperatureRange& wide) {
  if (!(dt_s > 0)) dt_s = 0;
  const double recovery_s = std::min(dt_s, kMaxRecovery_s);
  const double warmest = std::isnan(e.warmest_degC) ? wide.max_degC : e.warmest_degC;
  const double coldest = std::isnan(e.coldest_degC) ? wide.min_degC : e.coldest_degC;
  // fmax ignores a NaN.
  const double warm_end = std::min(std::fmax(warmest, e.target_degC), kHottest_degC);

  if (warmest > kWarm_degC)
    account_.dose_s += dose_rate(warm_end) * dt_s;
  else
    account_.dose_s *= std::exp(-recovery_s / kDecay_s);
  if (coldest < limits_.cold_degC)
    account_.cold_s += dt_s;
  else
    account_.cold_s = std::max(0.0, account_.cold_s - recovery_s);
  cut();

  // In the next step the plate may go to the end of the range, and must come back from there.
  const auto return_s = [&](double gap_K) { return e.delay_s + gap_K / e.return_K_s; };
  const double hottest = std::clamp(warmest, wide.max_degC, std::max(wide.max_degC, kHottest_degC));
  const double lowest = std::clamp(coldest, std::min(wide.min_degC, kColdest_degC), wide.min_degC);
  update_limits(hottest > kWarm_degC ? dose_rate(hottest) * return_s(hottest - kWarm_degC) : 0,
                lowest < limits_.cold_degC ? return_s(limits_.cold_degC - lowest) : 0);
  return {account_.cold_limited ? std::max(wide.min_degC, limits_.cold_degC + e.margin_K) : wide.min_degC,
          account_.warm_limited ? std::min(wide.max_degC, kWarm_degC - e.margin_K) : wide.max_degC};
}

// Bounds the recovery time. An infinite interval gives an infinite sum, which is cut, too.
void Dwell::cut() {
  account_.dose_s = std::min(account_.dose_s, 2 * limits_.dose_max_s);
  account_.cold_s = std::min(account_.cold_s, 2 * limits_.cold_max_s);
}

void Dwell::update_limits(double warm_reserve_s, double cold_reserve_s) {
  narrow(account_.warm_limited, account_.dose_s + warm_reserve_s, limits_.dose_max_s);
  narrow(account_.cold_limited, account_.cold_s + cold_reserve_s, limits_.cold_max_s);
}

void Dwell::resume(const DwellAccount& before) {
  account_ = before;
  account_.dose_s = usable(before.dose_s);
  account_.cold_s = usable(before.cold_s);
  cut();
}

}  // namespace tactus::thermal
