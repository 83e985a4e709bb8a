#include "sync/clocks/one_way_offset_estimator.h"

namespace tactus::sync {

Nanoseconds OneWayOffsetEstimator::offset_at(HostTime now) const {
  const double age_ns = static_cast<double>((now - improved_).count());
  return offset_ - Nanoseconds(static_cast<std::int64_t>(age_ns * kMaxDrift));
}

void OneWayOffsetEstimator::take(Nanoseconds bound, HostTime arrival) {
  offset_ = bound;
  improved_ = arrival;
  known_ = true;
  low_ = 0;
}

bool OneWayOffsetEstimator::low_for_long(Nanoseconds bound, HostTime arrival) {
  if (offset_at(arrival) - bound <= kNoticed) {
    low_ = 0;
    return false;
  }
  if (low_++ == 0) low_since_ = arrival;
  if (low_ == 1 || bound >= best_low_) {
    best_low_ = bound;
    best_low_at_ = arrival;
  }
  return low_ >= kWindowStamps && arrival - low_since_ >= kWindow;
}

bool OneWayOffsetEstimator::observe(std::int64_t stamp_ns, HostTime arrival) {
  const Nanoseconds bound(stamp_ns - to_ns(arrival));
  const bool jumped = known_ && (bound - offset_at(arrival) > kJump || offset_at(arrival) - bound > kJump);
  if (!known_ || jumped || bound >= offset_at(arrival)) {
    take(bound, arrival);
    return jumped;
  }
  if (!low_for_long(bound, arrival)) return false;
  take(best_low_, best_low_at_);
  return true;
}

HostTime OneWayOffsetEstimator::to_host(std::int64_t sender_ns, HostTime now) const {
  if (!known_) return host_time(sender_ns);
  return host_time(sender_ns) - offset_at(now);
}

}  // namespace tactus::sync
