// All other clocks as sync_node knows them, and the maps that it publishes of them. Pure.
#pragma once

#include <cstdint>
#include <map>
#include <tactus/clock_map_t.hpp>
#include <vector>

#include "sync/clock_sync/clock_probe.h"
#include "sync/clock_sync/offset_tracker.h"
#include "sync/time/time.h"

namespace tactus::sync {

class ClockAgreement {
 public:
  // A host that has not answered for so long is gone: its map is no longer published (design: 15 waves; those who need it go
  // on with the last one, which says how uncertain it has become).
  static constexpr Nanoseconds kGone{30'000'000'000};

  explicit ClockAgreement(std::int32_t own_clock) : own_clock_(own_clock) {}

  OffsetTracker::Outcome add(const ProbeWave& wave);
  // One map of each clock, of this instant.
  std::vector<clock_map_t> maps(HostTime now);
  // Since the start, over all clocks: jumps and changes of rate that were noticed.
  std::int64_t jumps() const { return jumps_; }
  std::int64_t rate_changes() const { return rate_changes_; }

 private:
  struct Other {
    OffsetTracker tracker;
    HostTime heard{};
    Nanoseconds round_trip{0};
    std::int32_t replies = 0;
  };
  std::int32_t own_clock_;
  std::map<std::int32_t, Other> others_;
  std::int64_t jumps_ = 0, rate_changes_ = 0;
};

}  // namespace tactus::sync
