// Limit on the duration of warm and cold exposure of skin: the allowed range narrows with the exposure, for any
// command. Pure.
#pragma once

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

  // Returns the range for the next dt, after a plate or finger has been at degC for the last; `wide` is the range
  // without exposure. NaN counts as both the warmest and the coldest of it.
  TemperatureRange step(double degC, double dt_s, const TemperatureRange& wide);

  // Continues with the exposure accumulated under other limits.
  void resume(const Dwell& before);

  double dose_s() const { return dose_s_; }
  double cold_s() const { return cold_s_; }

  // Exposure above this temperature is a dose; after too large a dose it is the upper limit.
  static constexpr double kWarm_degC = 39;
  // Time constant of the decay of the dose below that temperature: design, the minutes in which skin returns to
  // rest.
  static constexpr double kDecay_s = 300;

 private:
  DwellLimits limits_;
  double dose_s_ = 0, cold_s_ = 0;
  bool warm_limited_ = false, cold_limited_ = false;  // until half of the sum has decayed
};

}  // namespace tactus::thermal
