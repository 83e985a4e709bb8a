// Sound dose as a share of the daily allowance. Pure.
#pragma once

#include <cmath>
#include <string>

namespace tactus::audio {

// Rec. ITU-T H.870 (2018), 7.1: 80 dBA for 40 hours a week (mode 1, 1.6 Pa^2 h), 75 dBA for children (mode 2); 3
// dB more halve the time. The daily allowance is a seventh.
inline double sound_dose_days(double exposure_Pa2_s, double weekly_level_dB) {
  constexpr double kReference_Pa = 2e-5, kWeek_s = 40 * 3600;
  const double week_Pa2_s = kReference_Pa * kReference_Pa * std::pow(10, weekly_level_dB / 10) * kWeek_s;
  return 7 * exposure_Pa2_s / week_Pa2_s;
}

// For messages; empty while nothing was played.
inline std::string dose_text(double days) {
  if (!(days > 0)) return "";
  const long percent = std::lround(100 * days);
  return ", sound dose of this run " + (percent < 1 ? "below 1" : std::to_string(percent)) + " % of a day's";
}

}  // namespace tactus::audio
