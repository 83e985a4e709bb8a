// The treatment of events that could not be presented in time: a table with one row per modality.
//
//   lateness            <= tolerance     <= drop_after                          beyond
//   play with fade      unchanged        weaker, to nothing at drop_after       dropped
//   drop                unchanged        unchanged, reported late               dropped
//   show newest         unchanged        with the newest state, reported late   dropped
//   always apply        unchanged        applied, reported late                 applied, reported late; no modality waits for
//   it
//
// Every outcome is reported. Pure.
#pragma once

#include <cstdint>
#include <tactus/presentation_t.hpp>

#include "sync/time/time.h"

namespace tactus::sync {

enum class LateRule : std::uint8_t { kPlayWithFade, kDrop, kShowNewest, kAlwaysApply };

struct LatePolicy {
  LateRule rule = LateRule::kShowNewest;
  Nanoseconds tolerance{0};   // an event with at most this lateness is on time
  Nanoseconds drop_after{0};  // not before tolerance; ignored by kAlwaysApply

  // Returns presentation_t::PRESENTED, LATE or DROPPED_LATE.
  std::int8_t outcome(Nanoseconds lateness) const {
    if (lateness <= tolerance) return presentation_t::PRESENTED;
    return rule == LateRule::kAlwaysApply || lateness <= drop_after ? presentation_t::LATE
                                                                : presentation_t::DROPPED_LATE;
  }
  // Factor on the strength of an output with this lateness, 0 .. 1.
  double gain(Nanoseconds lateness) const {
    if (rule != LateRule::kPlayWithFade || lateness <= tolerance) return 1;
    if (lateness >= drop_after) return 0;
    return 1 - to_seconds(lateness - tolerance) / to_seconds(drop_after - tolerance);
  }
};

}  // namespace tactus::sync
