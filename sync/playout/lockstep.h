// The common loop of serial modalities: iterations begin at fixed instants of simulated time, the same in every process.
// Pure.
#pragma once

#include "sync/time/time.h"

namespace tactus::sync {

struct Lockstep {
  TimeMap map;
  double rate_Hz = 0;  // > 0

  // Start of the iteration that contains the host time t.
  HostTime begin_of_iteration(HostTime t) const { return map.to_host(iteration(map.to_sim(t), false)); }
  // Start of the first iteration at or after the host time t.
  HostTime next_iteration(HostTime t) const { return map.to_host(iteration(map.to_sim(t), true)); }

 private:
  SimTime iteration(SimTime t, bool up) const {
    const Nanoseconds period = from_seconds(1 / rate_Hz);
    const auto since = t.time_since_epoch();
    auto n = since / period;
    if (up && n * period < since) ++n;
    if (!up && n * period > since) --n;
    return SimTime(n * period);
  }
};

}  // namespace tactus::sync
