// How the senses shall lie in time to one another, as asked for; and the delays that follow from it. Pure.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>

#include "sync/playout/aligner.h"
#include "sync/time/time.h"

namespace tactus::sync {

enum class Policy : std::uint8_t {
  kAsap,              // as soon as each can
  kAligned,           // all when the slowest can
  kExperiment,        // base + SOA, whatever each can
  kLocalHapticFirst,  // touch at once, the others when the slowest of them can
  kItouch2005         // one after the other in one loop: touch, sound, heat, picture
};

// "asap", "aligned", "experiment", "local_haptic_first", "itouch2005". Throws std::invalid_argument with one
// sentence.
Policy policy_named(const std::string& word);
const char* name_of(Policy policy);

struct PlayoutPlan {
  Policy policy = Policy::kLocalHapticFirst;
  AlignerKind aligner = AlignerKind::kQuantile;
  // Common delay of kExperiment and of AlignerKind::kFixed. design: more than a picture of 60 Hz needs on a
  // software renderer, so that asynchronies of -100 ms can be had.
  Nanoseconds base{150'000'000};
  // Senses that need more are not waited for. design: an action and its effect still belong together to everyone
  // after 60 ms (the least thresholds of touch and picture in thresholds.csv)
  Nanoseconds budget{60'000'000};
  std::map<std::string, Nanoseconds> soa;  // of kExperiment, by modality

  // So many, with the longest names, fit one message.
  static constexpr std::size_t kMaxAsynchronies = 12;
  // Throws std::invalid_argument with one sentence when an asynchrony reaches before the event itself.
  void check() const;
};

// "audio=50ms,visual=-20ms". Throws std::invalid_argument with one sentence.
std::map<std::string, Nanoseconds> parse_soa(const std::string& text);
// "120ms", "0.12s". Throws std::invalid_argument with one sentence when it is none, negative, or longer than 60 s.
Nanoseconds parse_duration(const std::string& text);

// needed: what each sense needs by its aligner; senses not heard of yet are not in it. A sense that needs more
// than the budget is not waited for: it is late, and the others stay where they are. Neither is a slow one.
std::map<std::string, Nanoseconds> playout_delays(const PlayoutPlan& plan,
                                                  const std::map<std::string, Nanoseconds>& needed,
                                                  const std::set<std::string>& slow = {});

// Of kItouch2005: rate of a loop in which every sense waits for the one before, Hz; 0 for any other policy or
// before anything is known.
double lockstep_rate_Hz(const PlayoutPlan& plan, const std::map<std::string, Nanoseconds>& needed);

}  // namespace tactus::sync
