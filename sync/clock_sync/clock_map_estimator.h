// The offset trackers of all other clocks, and the maps that sync_node publishes of them. Pure.
#pragma once

#include <cstdint>
#include <map>
#include <tactus/clock_map_t.hpp>
#include <vector>

#include "sync/clock_sync/clock_probe.h"
#include "sync/clock_sync/offset_tracker.h"
#include "sync/time/time.h"

namespace tactus::sync {

class ClockMapEstimator {
 public:
  // A host that has not answered for this time is gone, and its map is no longer published (design: 15 waves). Receivers
  // continue with the last map, which contains the growth of its uncertainty.
  static constexpr Nanoseconds kTimeout{30'000'000'000};

  explicit ClockMapEstimator(std::int32_t own_clock) : own_clock_(own_clock) {}

  OffsetTracker::Outcome add(const ProbeWave& wave);
  // One map of each clock, for this instant.
  std::vector<clock_map_t> maps(HostTime now);

 private:
  struct Other {
    OffsetTracker tracker;
    HostTime last_wave{};
    Nanoseconds round_trip{0};
    std::int32_t replies = 0;
  };
  std::int32_t own_clock_;
  std::map<std::int32_t, Other> others_;
};

}  // namespace tactus::sync
