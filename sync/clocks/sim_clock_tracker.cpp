#include "sync/clocks/sim_clock_tracker.h"

#include <algorithm>

namespace tactus::sync {

namespace {

Nanoseconds distance(SimTime a, SimTime b) { return a < b ? b - a : a - b; }

}  // namespace

// Compares on the sender's clock. The rate may have changed at any instant since, so either rate is accepted.
bool SimClockTracker::contradicts(const header_t& header, const sim_clock_t& clock) const {
  const HostTime t = host_time(header.publish_time_ns);
  const TimeMap published{sim_time(clock.sim_ns), host_time(clock.host_ns), clock.rate};
  const auto deviates = [&](double rate) {
    const TimeMap known{sim_time(clock_.sim_ns), host_time(clock_.host_ns), rate};
    return distance(known.to_sim(t), published.to_sim(t)) > kMaxDeviation;
  };
  return deviates(clock_.rate) && deviates(clock.rate);
}

TrackResult SimClockTracker::track(const header_t& header, const sim_clock_t& clock, HostTime arrival) {
  TrackResult result = TrackResult::kSame;
  const SenderStatus status = sender_of_world_.on_page(header, arrival);
  if (!accepted(status)) return TrackResult::kIgnore;
  known_ = true;
  if (status == SenderStatus::kFirst) {
    result = TrackResult::kRestart;
  } else if (header.publish_time_ns < newest_publish_ns_ - kMaxStepBack.count()) {
    result = TrackResult::kRestart;
  } else if (contradicts(header, clock) && arrival - confirmed_ < kSilence) {
    return TrackResult::kIgnore;
  }
  confirmed_ = arrival;
  if (result == TrackResult::kRestart) {
    sender_ = SenderClock(own_);
    newest_publish_ns_ = 0;
  }
  last_arrival_ = std::max(last_arrival_, arrival);
  sender_.observe(header, arrival);
  if (header.publish_time_ns >= newest_publish_ns_) {
    newest_publish_ns_ = header.publish_time_ns;
    clock_ = clock;
  }
  return result;
}

std::optional<TimeMap> SimClockTracker::map(HostTime now) const {
  if (!known_) return std::nullopt;
  return TimeMap{sim_time(clock_.sim_ns), sender_.to_host(clock_.host_ns, now), clock_.rate};
}

}  // namespace tactus::sync
