// Published map between simulated time and the host clock. It follows the actual loop but slews, so that a missed
// tick does not disturb the renderers. Pure.
//
// A simulation that cannot keep up keeps its step length: simulated time falls behind, the offset of the map grows,
// and the map's rate shows the speed.
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>

#include "sync/time/time.h"

namespace tactus::sim {

class SimPacer {
 public:
  // Time constant of the map, s of simulated time: a missed tick of 1 ms causes a slew of 5 % that is over after 60
  // ms.
  static constexpr double kFollow_s = 0.02;

  // One tick: the world is at `sim` at the deadline `due` of the loop. Both must increase from call to call.
  sync::TimeMap tick(sync::SimTime sim, sync::HostTime due);
  // One tick of a pause at `sim`: the map has rate 0 and stays constant until the next tick(), which begins a new
  // map.
  sync::TimeMap hold(sync::SimTime sim, sync::HostTime due);
  // Simulated seconds per host second over the last whole second; 0 during a pause.
  double realtime_factor() const { return held_ ? 0 : factor_; }

 private:
  sync::HostTime host_of(sync::SimTime sim) const {
    return sync::host_time(sync::to_ns(sim) + base_ns_ + std::llround(*offset_ns_));
  }

  std::optional<sync::HostTime> held_;
  std::optional<double> offset_ns_;  // host - sim, minus base_ns_
  std::int64_t base_ns_ = 0;
  sync::SimTime last_sim_{};
  sync::SimTime window_sim_{};
  sync::HostTime window_host_{};
  double factor_ = 1;
};

}  // namespace tactus::sim
