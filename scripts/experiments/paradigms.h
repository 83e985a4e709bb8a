// The paradigms of published experiments. A trial presents stimuli to the senses of a participant and answers; it
// receives neither a published result nor the analysis. Pure.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scripts/experiments/participant.h"
#include "scripts/experiments/trial_settings.h"

namespace tactus::experiments {

struct Paradigm {
  const char* name;
  const char* summary;
  // number: equal numbers give equal noise, in every condition. Throws std::invalid_argument for a wrong setting.
  Outcome (*run)(Participant& participant, const TrialSettings& settings, std::uint64_t number);
  // Properties of a participant on which the answers depend: names of observer::parameter_ranges and
  // timing_ranges.
  std::vector<const char*> properties;
};

const std::vector<Paradigm>& paradigms();

// One trial; refuses unknown paradigms and settings.
Outcome run_trial(const std::string& paradigm, Participant& participant, const TrialSettings& settings,
                  std::uint64_t number);

// Judgements of time, of events.cpp.
Outcome two_events(Participant& participant, const TrialSettings& settings, std::uint64_t number);
// Aimed movements, of aimed_movements.cpp.
Outcome pointing(Participant& participant, const TrialSettings& settings, std::uint64_t number);
Outcome tapping(Participant& participant, const TrialSettings& settings, std::uint64_t number);
// Objects that are moved through a coupling, of joint_carry.cpp and pursuit.cpp.
Outcome joint_carry(Participant& participant, const TrialSettings& settings, std::uint64_t number);
Outcome pursuit(Participant& participant, const TrialSettings& settings, std::uint64_t number);
// An arm in an environment whose force is late, of stroke.cpp and press_spring.cpp.
Outcome stroke(Participant& participant, const TrialSettings& settings, std::uint64_t number);
Outcome press_spring(Participant& participant, const TrialSettings& settings, std::uint64_t number);
Outcome deadband(Participant& participant, const TrialSettings& settings, std::uint64_t number);
// Properties of things, of bar_size.cpp, impact_material.cpp and contact_cooling.cpp.
Outcome bar_size(Participant& participant, const TrialSettings& settings, std::uint64_t number);
Outcome impact_material(Participant& participant, const TrialSettings& settings, std::uint64_t number);
Outcome contact_cooling(Participant& participant, const TrialSettings& settings, std::uint64_t number);

}  // namespace tactus::experiments
