#include "sync/sender_clock.h"

namespace tactus::sync {

Nanoseconds SenderClock::offset_at(HostTime now) const {
  const double age_ns = static_cast<double>((now - improved_).count());
  return offset_ - Nanoseconds(static_cast<std::int64_t>(age_ns * kMaxDrift));
}

bool SenderClock::observe(std::int64_t stamp_ns, HostTime arrival, bool same_clock) {
  same_clock_ = same_clock;
  if (same_clock) {
    known_ = true;
    offset_ = Nanoseconds(0);
    return false;
  }
  const Nanoseconds bound(stamp_ns - to_ns(arrival));
  const bool jumped = known_ && (bound - offset_at(arrival) > kJump || offset_at(arrival) - bound > kJump);
  if (!known_ || jumped || bound >= offset_at(arrival)) {
    offset_ = bound;
    improved_ = arrival;
    known_ = true;
  }
  return jumped;
}

HostTime SenderClock::to_host(std::int64_t sender_ns, HostTime now) const {
  if (!known_ || same_clock_) return host_time(sender_ns);
  return host_time(sender_ns) - offset_at(now);
}

}  // namespace tactus::sync
