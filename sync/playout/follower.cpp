#include "sync/playout/follower.h"

#include <algorithm>
#include <tactus/playout_entry_t.hpp>

namespace tactus::sync {

void PlayoutFollower::take(const playout_t& m) {
  lockstep_Hz_ = m.lockstep_Hz;
  policy_ = m.policy;
  for (const playout_entry_t& e : m.entries)
    if (e.modality == modality_) told_ = Nanoseconds(e.delay_ns);
}

Nanoseconds PlayoutFollower::step(HostTime now) {
  const double dt_s = last_ ? to_seconds(now - *last_) : 0;
  last_ = now;
  const Nanoseconds most = from_seconds(std::clamp(dt_s, 0.0, 1.0) * kSlew);
  delay_ += std::clamp(told_.value_or(own_) - delay_, -most, most);
  return delay_;
}

}  // namespace tactus::sync
