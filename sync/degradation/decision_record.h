// The decisions of a profile, for the log.
#pragma once

#include <cstdint>
#include <vector>

#include "sync/degradation/operator_chain.h"

namespace tactus::sync {

struct DecisionRecord {
  std::uint64_t key = 0;  // id of an event, or snapshot_key of a snapshot
  bool is_event = false;
  SimTime time{};
  Decision decision;
  HostTime arrival{};
  std::uint64_t stream = 0;  // of a snapshot, as in StreamItem
};
using Decisions = std::vector<DecisionRecord>;

}  // namespace tactus::sync
