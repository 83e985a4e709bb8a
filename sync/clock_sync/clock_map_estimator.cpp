#include "sync/clock_sync/clock_map_estimator.h"

namespace tactus::sync {

OffsetTracker::Outcome ClockMapEstimator::add(const ProbeWave& wave) {
  Other& other = others_[wave.clock];
  other.last_wave = wave.sample.at;
  other.round_trip = wave.round_trip;
  other.replies = wave.replies;
  return other.tracker.add(wave.sample);
}

std::vector<clock_map_t> ClockMapEstimator::maps(HostTime now) {
  std::erase_if(others_, [&](const auto& entry) { return now - entry.second.last_wave > kTimeout; });
  std::vector<clock_map_t> out;
  for (auto& [clock, other] : others_) {
    const OffsetLine line = other.tracker.line(now);
    clock_map_t m{};
    m.header.sim_time_ns = -1;
    m.of_clock = clock;
    m.to_clock = own_clock_;
    m.at_ns = to_ns(line.at);
    m.offset_ns = line.offset.count();
    m.drift = line.drift;
    m.uncertainty_ns = line.uncertainty.count();
    m.uncertainty_drift = line.uncertainty_drift;
    m.epoch = line.epoch;
    m.round_trip_ns = other.round_trip.count();
    m.replies = other.replies;
    out.push_back(m);
  }
  return out;
}

}  // namespace tactus::sync
