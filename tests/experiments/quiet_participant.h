// Participants without noise, or with endless noise, for closed-form limits of the paradigms.
#pragma once

#include "scripts/experiments/paradigms.h"

namespace tactus::experiments {

// Every noise of the senses is scaled by `noise`; beliefs are right, and no trial is missed.
inline Participant scaled_participant(double noise, std::uint64_t seed = 1) {
  observer::PlayerParameters p;
  p.lapse = 0;
  p.initial_delay_error_s = 0;
  for (double observer::PlayerParameters::*field :
       {&observer::PlayerParameters::visual_sd_deg, &observer::PlayerParameters::proprioceptive_sd_m,
        &observer::PlayerParameters::force_weber, &observer::PlayerParameters::stiffness_weber,
        &observer::PlayerParameters::thermal_weber})
    p.*field *= noise;
  p.motor_noise_share = 0;
  Timing t;
  t.touch_sd_s *= noise, t.sight_sd_s *= noise, t.sound_sd_s *= noise;
  return Participant(p, t, seed);
}

// A noise that hides every stimulus; the visual noise stays below a right angle.
constexpr double kHidesAll = 500;

inline double answered(Participant& p, const char* paradigm, std::map<std::string, std::string> settings,
                       std::uint64_t number = 0, const char* outcome = nullptr) {
  for (const auto& [name, value] : run_trial(paradigm, p, TrialSettings(std::move(settings)), number))
    if (outcome == nullptr || std::string(outcome) == name) return value;
  throw std::runtime_error("no such outcome");
}

// Share of yes over `count` trials.
inline double share(Participant& p, const char* paradigm, const std::map<std::string, std::string>& settings,
                    int count = 1000) {
  double sum = 0;
  for (int i = 0; i < count; ++i) sum += answered(p, paradigm, settings, static_cast<std::uint64_t>(i));
  return sum / count;
}

}  // namespace tactus::experiments
