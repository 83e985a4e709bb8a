#include "sync/clocks/sender_clock.h"

namespace tactus::sync {

bool SenderClock::observe(const header_t& h, HostTime arrival) {
  if (known_ && (h.clock != clock_ || h.run_id != run_id_)) {
    one_way_ = OneWayOffsetEstimator{};
    distrust_until_ = HostTime{};
  }
  known_ = true;
  run_id_ = h.run_id;
  clock_ = h.clock;
  if (same_run() && clock_ == own_.clock) return false;
  const bool jumped = one_way_.observe(h.publish_time_ns, arrival);
  const Reading reading = read(h.publish_time_ns, arrival);
  if (reading.source != ClockSource::kMapped) return jumped;
  const bool contradicted = reading.time - reading.uncertainty > arrival + kTolerance;
  if (contradicted) distrust_until_ = arrival + kDistrust;
  return contradicted;
}

SenderClock::Reading SenderClock::read(std::int64_t sender_ns, HostTime now) const {
  if (!known_) return {host_time(sender_ns), ClockSource::kUnknown, Nanoseconds(-1)};
  if (same_run() && clock_ == own_.clock) return {host_time(sender_ns), ClockSource::kSame, Nanoseconds(0)};
  if (same_run() && own_.maps != nullptr && now >= distrust_until_)
    if (const auto mapped = own_.maps->read(host_time(sender_ns), clock_, own_.clock))
      return {mapped->time, ClockSource::kMapped, mapped->uncertainty};
  return {one_way_.to_host(sender_ns, now), ClockSource::kOneWay, Nanoseconds(-1)};
}

}  // namespace tactus::sync
