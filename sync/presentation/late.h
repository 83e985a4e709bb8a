// What becomes of an event that could not be presented in time: one table, a row per sense.
//
//   lateness            <= tolerance     <= drop_after                          beyond
//   play with fade      as it should be  weaker, to nothing at drop_after       dropped
//   drop                as it should be  as it should be, called late           dropped
//   show newest         as it should be  with what is newest then, called late  dropped
//   always apply        as it should be  applied, called late                   applied, called late; nobody waits for it
//
// Every outcome is reported. Pure.
#pragma once

#include <algorithm>
#include <cstdint>
#include <tactus/presentation_t.hpp>

#include "sync/time/time.h"

namespace tactus::sync {

enum class Late : std::uint8_t { kPlayWithFade, kDrop, kShowNewest, kAlwaysApply };

struct LatePolicy {
  Late rule = Late::kShowNewest;
  Nanoseconds tolerance{0};   // up to so late it is on time
  Nanoseconds drop_after{0};  // not before tolerance; of no meaning to kAlwaysApply

  // presentation_t::PRESENTED, LATE or DROPPED_LATE.
  std::int8_t outcome(Nanoseconds lateness) const {
    if (lateness <= tolerance) return presentation_t::PRESENTED;
    return rule == Late::kAlwaysApply || lateness <= drop_after ? presentation_t::LATE
                                                                : presentation_t::DROPPED_LATE;
  }
  // Factor on the strength of what is presented so late, 0 .. 1.
  double gain(Nanoseconds lateness) const {
    if (rule != Late::kPlayWithFade || lateness <= tolerance) return 1;
    if (lateness >= drop_after) return 0;
    return 1 - to_seconds(lateness - tolerance) / to_seconds(drop_after - tolerance);
  }
};

}  // namespace tactus::sync
