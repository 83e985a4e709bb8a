// The map between simulated time and the host's clock, as it is published. It follows what the loop really does but slews:
// a tick that was missed shakes no renderer. Pure.
//
// A simulation that cannot keep up keeps its step: simulated time falls behind, the offset of the map grows, and its rate
// says how fast.
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>

#include "sync/time/time.h"

namespace tactus::sim {

class SimPacer {
 public:
  // Time in which the map follows, s of the world: a missed tick of 1 ms is a slew of 5 % that is over after 60 ms.
  static constexpr double kFollow_s = 0.02;

  // One tick: the world is at `sim` at the deadline `due` of the loop. Call with ever later times.
  sync::TimeMap tick(sync::SimTime sim, sync::HostTime due);
  // One tick in which the world stands still at `sim`: the map has rate 0 and moves no more until the next tick(), which
  // begins a new one.
  sync::TimeMap hold(sync::SimTime sim, sync::HostTime due);
  // Simulated seconds per host second over the last whole second; 0 while the world stands still.
  double realtime_factor() const { return held_ ? 0 : factor_; }

 private:
  sync::HostTime host_of(sync::SimTime sim) const {
    return sync::host_time(sync::to_ns(sim) + base_ns_ + std::llround(*offset_ns_));
  }

  std::optional<sync::HostTime> held_;
  std::optional<double> offset_ns_;  // host - sim, since base_
  std::int64_t base_ns_ = 0;
  sync::SimTime last_sim_{};
  sync::SimTime window_sim_{};
  sync::HostTime window_host_{};
  double factor_ = 1;
};

}  // namespace tactus::sim
