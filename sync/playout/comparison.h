// Compares aligners: applies one aligner to a trace of needed delays and computes the asynchronies of the common delay that
// it chooses. Pure.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "sync/playout/aligner.h"

namespace tactus::sync {

// The delay that each modality needed for one event.
using TraceEvent = std::map<std::string, Nanoseconds>;

struct AlignerResult {
  std::int64_t events = 0;        // without the learning events
  Nanoseconds asynchrony_p50{0};  // from the first to the last modality
  Nanoseconds asynchrony_p95{0};
  Nanoseconds added_mean{0};  // presentation minus earliest possible presentation
  Nanoseconds delay_last{0};  // in force at the end
  double late_share = 0;      // share of all presentations that needed more than the delay
};

// Every modality has its own aligner, and all wait for the slowest. fixed: the delay of kFixed. learn: number of leading
// events that are not counted.
AlignerResult simulate_aligner(const std::vector<TraceEvent>& trace, AlignerKind kind, Nanoseconds fixed,
                              std::size_t learn = 32);

}  // namespace tactus::sync
