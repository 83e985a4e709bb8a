// The common loop of serial senses: turns at fixed instants of the world, the same in every process. Pure.
#pragma once

#include "sync/time/time.h"

namespace tactus::sync {

struct Lockstep {
  TimeMap map;
  double rate_Hz = 0;  // > 0

  // The turn that a host time lies in began then.
  HostTime begin_of_turn(HostTime t) const { return map.to_host(turn(map.to_sim(t), false)); }
  // The first turn that begins at a host time or after it.
  HostTime next_turn(HostTime t) const { return map.to_host(turn(map.to_sim(t), true)); }

 private:
  SimTime turn(SimTime t, bool up) const {
    const Nanoseconds period = from_seconds(1 / rate_Hz);
    const auto since = t.time_since_epoch();
    auto n = since / period;
    if (up && n * period < since) ++n;
    if (!up && n * period > since) --n;
    return SimTime(n * period);
  }
};

}  // namespace tactus::sync
