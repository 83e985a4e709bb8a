#include "sync/clocks/one_way_offset_estimator.h"

namespace tactus::sync {

Nanoseconds OneWayOffsetEstimator::offset_at(HostTime now) const {
  const double age_ns = static_cast<double>((now - improved_).count());
  return offset_ - Nanoseconds(static_cast<std::int64_t>(age_ns * kMaxDrift));
}

void OneWayOffsetEstimator::adopt(Nanoseconds bound, HostTime arrival) {
  offset_ = bound;
  improved_ = arrival;
  known_ = true;
  low_count_ = 0;
}

bool OneWayOffsetEstimator::low_for_window(Nanoseconds bound, HostTime arrival) {
  if (offset_at(arrival) - bound <= kMinJump) {
    low_count_ = 0;
    return false;
  }
  if (low_count_++ == 0) low_since_ = arrival;
  if (low_count_ == 1 || bound >= max_low_bound_) {
    max_low_bound_ = bound;
    max_low_bound_at_ = arrival;
  }
  return low_count_ >= kWindowStamps && arrival - low_since_ >= kWindow;
}

bool OneWayOffsetEstimator::observe(std::int64_t stamp_ns, HostTime arrival) {
  const Nanoseconds bound(stamp_ns - to_ns(arrival));
  const bool jumped = known_ && (bound - offset_at(arrival) > kJump || offset_at(arrival) - bound > kJump);
  if (!known_ || jumped || bound >= offset_at(arrival)) {
    adopt(bound, arrival);
    return jumped;
  }
  if (!low_for_window(bound, arrival)) return false;
  adopt(max_low_bound_, max_low_bound_at_);
  return true;
}

HostTime OneWayOffsetEstimator::to_host(std::int64_t sender_ns, HostTime now) const {
  if (!known_) return host_time(sender_ns);
  return host_time(sender_ns) - offset_at(now);
}

}  // namespace tactus::sync
