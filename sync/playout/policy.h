// Playout policies and the delays that they imply. Pure.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>

#include "sync/playout/aligner.h"
#include "sync/time/time.h"

namespace tactus::sync {

enum class Policy : std::uint8_t {
  kAsap,              // each as soon as it can
  kAligned,           // all when the slowest can
  kExperiment,        // base + SOA, regardless of the needs
  kLocalHapticFirst,  // touch immediately, the others when the slowest of them can
  kItouch2005         // one after the other in one loop: touch, sound, picture, then all others
};

// "asap", "aligned", "experiment", "local_haptic_first", "itouch2005". Throws std::invalid_argument with one
// sentence.
Policy parse_policy(const std::string& word);
const char* name_of(Policy policy);

struct PlayoutPlan {
  Policy policy = Policy::kLocalHapticFirst;
  AlignerKind aligner = AlignerKind::kQuantile;
  // Common delay of kExperiment and of AlignerKind::kFixed. design: more than a 60 Hz picture needs on a software renderer,
  // so that asynchronies of -100 ms are possible.
  Nanoseconds base{150'000'000};
  // The others do not wait for modalities that need more. design: 60 ms after an action, its effect still belongs to it for
  // everyone (the least thresholds of touch and picture in thresholds.csv)
  Nanoseconds budget{60'000'000};
  std::map<std::string, Nanoseconds> soa;  // of kExperiment, by modality

  // This number, with the longest names, fits one message.
  static constexpr std::size_t kMaxAsynchronies = 12;
  // Throws std::invalid_argument with one sentence when an asynchrony is earlier than the event itself.
  void check() const;
};

// "audio=50ms,visual=-20ms". Throws std::invalid_argument with one sentence.
std::map<std::string, Nanoseconds> parse_soa(const std::string& text);
// "120ms", "0.12s". Throws std::invalid_argument with one sentence when it is not a duration, is negative, or longer than 60 s.
Nanoseconds parse_duration(const std::string& text);

// needed: the needs by the aligners; modalities without a report are not in it. The others do not wait for a modality that
// needs more than the budget (it is late), or for a slow one.
std::map<std::string, Nanoseconds> playout_delays(const PlayoutPlan& plan,
                                                  const std::map<std::string, Nanoseconds>& needed,
                                                  const std::set<std::string>& slow = {});

// Only for kItouch2005: rate, Hz, of a loop in which every modality waits for the one before. 0 for any other policy, or
// before any demand is known.
double lockstep_rate_Hz(const PlayoutPlan& plan, const std::map<std::string, Nanoseconds>& needed);

}  // namespace tactus::sync
