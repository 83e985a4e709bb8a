// The time that passes for a stream of snapshots: simulated time, and publication time while the world stands still. Pure.
#pragma once

#include <algorithm>
#include <cstdint>

#include "sync/time/time.h"

namespace tactus::sync {

// A tool moves on while the world is paused, and its snapshots then carry the same simulated time. A low-pass over simulated
// time would stand still with the world.
class StreamPace {
 public:
  // A snapshot, in order of arrival: its simulated time, and its time of publication by the clock of its sender, ns. Returns a
  // time that is at least `t` and grows with every newer snapshot. A fall of simulated time by more than a second is a
  // restart, as in sync/clocks/sim_clock_tracker.h.
  SimTime advance(SimTime t, std::int64_t publish_ns) {
    if (!started_ || newest_ - t > kMaxStepBack) *this = StreamPace(t, publish_ns);
    if (t <= newest_) stood_ += Nanoseconds(std::max<std::int64_t>(0, publish_ns - newest_publish_ns_));
    newest_ = std::max(newest_, t);
    newest_publish_ns_ = std::max(newest_publish_ns_, publish_ns);
    return newest_ + stood_;
  }
  StreamPace() = default;

 private:
  static constexpr Nanoseconds kMaxStepBack{1'000'000'000};
  StreamPace(SimTime t, std::int64_t publish_ns) : newest_(t), newest_publish_ns_(publish_ns), started_(true) {}

  SimTime newest_{};
  Nanoseconds stood_{0};  // sum of the times in which the world stood still
  std::int64_t newest_publish_ns_ = 0;
  bool started_ = false;
};

}  // namespace tactus::sync
