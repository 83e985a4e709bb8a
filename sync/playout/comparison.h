// One trace of what events needed, through one aligner: what a common delay chosen by it would have given. Pure.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "sync/playout/aligner.h"

namespace tactus::sync {

// What each sense needed for one event.
using TraceEvent = std::map<std::string, Nanoseconds>;

struct AlignerResult {
  std::int64_t events = 0;        // after those that it learned from
  Nanoseconds asynchrony_p50{0};  // of the last sense to the first
  Nanoseconds asynchrony_p95{0};
  Nanoseconds added_mean{0};  // presented later than it could have been
  Nanoseconds delay_last{0};  // in force at the end
  double late_share = 0;      // of all presentations: needed more than the delay
};

// Every sense has an aligner of its own, and all wait for the slowest. fixed: the delay of kFixed. learn: so many
// events are not counted.
AlignerResult through_aligner(const std::vector<TraceEvent>& trace, AlignerKind kind, Nanoseconds fixed,
                              std::size_t learn = 32);

}  // namespace tactus::sync
