#include "sync/playout/follower.h"

#include <algorithm>
#include <tactus/playout_entry_t.hpp>

namespace tactus::sync {

void PlayoutFollower::push(const playout_t& m, HostTime at) {
  if (last_ && at > *last_) step(at);
  lockstep_Hz_ = m.lockstep_Hz;
  policy_ = m.policy;
  for (const playout_entry_t& e : m.entries)
    if (e.modality == modality_) published_ = Nanoseconds(e.delay_ns);
}

Nanoseconds PlayoutFollower::delay_at(HostTime later) const {
  const double dt_s = last_ ? to_seconds(later - *last_) : 0;
  const Nanoseconds max_step = from_seconds(std::clamp(dt_s, 0.0, 1.0) * kSlew);
  return delay_ + std::clamp(published_.value_or(own_) - delay_, -max_step, max_step);
}

Nanoseconds PlayoutFollower::step(HostTime now) {
  delay_ = delay_at(now);
  last_ = now;
  return delay_;
}

HostTime PlayoutFollower::presentation_of(HostTime happened, Nanoseconds added) const {
  HostTime presented = happened + added + delay_;
  // Each round leaves a twentieth of the error (kSlew): of 100 ms, 12 ns after five.
  for (int round = 0; round < 5; ++round) presented = happened + added + delay_at(presented);
  return presented;
}

}  // namespace tactus::sync
