// Limit on the duration of warm and cold exposure of skin: the allowed range narrows with the exposure, for any
// command. Pure.
#pragma once

#include <limits>

namespace tactus::thermal {

struct DwellLimits {
  double dose_max_s = 60;  // seconds at 43 degC, or the equivalent
  double cold_degC = 20;   // exposure below this temperature is counted
  double cold_max_s = 60;
};

// Range of allowed commands.
struct TemperatureRange {
  double min_degC, max_degC;
};

// Temperatures under a finger during one step, and the time that the display needs to leave them.
struct Exposure {
  // Of the commanded and the measured temperature. NaN: unknown, counts as the worst of the range.
  double warmest_degC, coldest_degC;
  // The command moves towards this temperature, maybe slowly. NaN: not known.
  double target_degC = std::numeric_limits<double>::quiet_NaN();
  // Slowest return of the plate, and the time until the return begins, the next step included.
  double return_K_s = std::numeric_limits<double>::infinity(), delay_s = 0;
  // The narrower range is inside the limits by this, because a plate swings about its command: a plate at 39.01
  // degC would never recover.
  double margin_K = 0;
};

// Sums of warm and cold exposure, in a form that can be stored.
struct DwellAccount {
  double dose_s = 0, cold_s = 0;
  bool warm_limited = false, cold_limited = false;  // until half of the sum has decayed

  // Of a person whose exposure is unknown: both limits are reached. Dwell cuts the sums to its limits.
  static constexpr DwellAccount full() { return {1e6, 1e6, true, true}; }
  // After `seconds` at neutral, >= 0. The next step of Dwell updates the limits.
  DwellAccount recovered(double seconds) const;
};

// Warmth is summed as the dose of Sapareto and Dewey 1984: seconds at 43 degC; each kelvin more doubles the rate,
// each kelvin less quarters it. At 43 degC a burn takes 8 h (ISO 13732-1:2006), so the default of a minute is a
// comfort limit far from harm: 4 min at 42 degC. Heat pain begins at a receptor temperature of 43.2 degC (Stoll
// and Greene 1959), in skin at 42.0 to 44.5 degC (Defrin et al. 2006, as tabulated in doi
// 10.1097/HP.0000000000001447, table 4). It depends on the duration, not on the rate of change (Nielsen and
// Arendt-Nielsen 1998, same table); hence a limit on time and none on rate. Cold is summed as plain time below
// `cold_degC`: touching cold objects is slightly painful at 19 degC of the palm (Havenith, van de Linde and Heus
// 1992) and hurts from 15 degC on (ISO 13732-3:2005). Realtime-safe: yes.
class Dwell {
 public:
  explicit Dwell(const DwellLimits& limits) : limits_(limits) {}

  // Returns the range for the next dt, after `exposure` for the last dt; `wide` is the range without exposure. The
  // way to the end of that range and back counts beforehand, so the sums stay within the limits until the plate is
  // back. While the plate is warm, the dose counts at the rate of the target: a slow approach does not lengthen
  // the time above kWarm_degC.
  TemperatureRange step(const Exposure& exposure, double dt_s, const TemperatureRange& wide);
  // The same for a plate or finger at degC that returns at once.
  TemperatureRange step(double degC, double dt_s, const TemperatureRange& wide) {
    return step(Exposure{degC, degC}, dt_s, wide);
  }
  // Continues with the exposure accumulated under other limits. Sums that are not finite or negative count as
  // full.
  void resume(const Dwell& before) { resume(before.account_); }
  void resume(const DwellAccount& before);
  const DwellAccount& account() const { return account_; }
  double dose_s() const { return account_.dose_s; }
  double cold_s() const { return account_.cold_s; }

  // Exposure above this temperature is a dose; after too large a dose it is the upper limit.
  static constexpr double kWarm_degC = 39;
  // Time constant of the decay of the dose below that temperature: design, the minutes in which skin returns to
  // rest.
  static constexpr double kDecay_s = 300;

  // Longest recovery that one step counts. A longer gap was not observed; design: ten ticks at the lowest rate.
  static constexpr double kMaxRecovery_s = 1;

 private:
  void cut();
  void update_limits(double warm_reserve_s, double cold_reserve_s);

  DwellLimits limits_;
  DwellAccount account_;
};

}  // namespace tactus::thermal
