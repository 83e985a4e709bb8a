#include "sync/playout/follower.h"

#include <algorithm>
#include <tactus/playout_entry_t.hpp>

namespace tactus::sync {

void PlayoutFollower::push(const playout_t& m) {
  lockstep_Hz_ = m.lockstep_Hz;
  policy_ = m.policy;
  for (const playout_entry_t& e : m.entries)
    if (e.modality == modality_) published_ = Nanoseconds(e.delay_ns);
}

Nanoseconds PlayoutFollower::step(HostTime now) {
  const double dt_s = last_ ? to_seconds(now - *last_) : 0;
  last_ = now;
  const Nanoseconds max_step = from_seconds(std::clamp(dt_s, 0.0, 1.0) * kSlew);
  delay_ += std::clamp(published_.value_or(own_) - delay_, -max_step, max_step);
  return delay_;
}

}  // namespace tactus::sync
