#include "sync/clocks/clock_maps.h"

#include <cmath>
#include <tactus/clock_map_t.hpp>

namespace tactus::sync {
namespace {

Nanoseconds scaled(Nanoseconds d, double factor) {
  return Nanoseconds(std::llround(static_cast<double>(d.count()) * factor));
}
// Received times may have any value. Those of a map are range-checked on reception, other times here.
constexpr std::int64_t kMaxTime_ns = std::int64_t{1} << 60;
bool representable(HostTime t) { return to_ns(t) >= 0 && to_ns(t) <= kMaxTime_ns; }

}  // namespace

ClockLine::ClockLine(const clock_map_t& m)
    : at_(host_time(m.at_ns)),
      offset_(m.offset_ns),
      drift_(m.drift),
      uncertainty_(m.uncertainty_ns),
      uncertainty_drift_(m.uncertainty_drift) {}

Nanoseconds ClockLine::uncertainty_at(Nanoseconds since) const {
  // One nanosecond for each of the two roundings.
  return uncertainty_ + scaled(since < Nanoseconds(0) ? -since : since, uncertainty_drift_) + Nanoseconds(2);
}

ClockReading ClockLine::of_to_target(HostTime of) const {
  // of = to + offset + drift * (to - at), solved for to - at: the difference is small, so a double is precise enough.
  const Nanoseconds since = scaled(of - at_ - offset_, 1 / (1 + drift_));
  return {at_ + since, uncertainty_at(since)};
}

ClockReading ClockLine::target_to_of(HostTime to) const {
  const Nanoseconds since = to - at_;
  return {to + offset_ + scaled(since, drift_), uncertainty_at(since)};
}

void ClockMaps::observe(const clock_map_t& m, HostTime arrival) {
  if (run_id_ == 0) run_id_ = m.header.run_id;
  if (m.header.run_id != run_id_) {
    ++foreign_;
    return;
  }
  const std::pair key{m.of_clock, m.to_clock};
  const Known now{ClockLine(m), m.header.source, m.header.incarnation, m.header.seq, arrival};
  const auto it = known_.find(key);
  if (it == known_.end()) {
    if (known_.size() < kMax) known_.emplace(key, now);
    return;
  }
  const Known& before = it->second;
  const bool same = before.incarnation == now.incarnation && before.source == now.source;
  if (same ? now.seq < before.seq : arrival - before.arrival < kTimeout) return;
  it->second = now;
}

std::optional<ClockReading> ClockMaps::read(HostTime time, std::int32_t of_clock, std::int32_t on_clock) const {
  if (!representable(time)) return std::nullopt;
  if (of_clock == on_clock) return ClockReading{time, Nanoseconds(0)};
  std::optional<ClockReading> out;
  if (const auto it = known_.find({of_clock, on_clock}); it != known_.end())
    out = it->second.line.of_to_target(time);
  else if (const auto back = known_.find({on_clock, of_clock}); back != known_.end())
    out = back->second.line.target_to_of(time);
  if (out && out->uncertainty > kMaxUncertainty) out.reset();
  return out;
}

}  // namespace tactus::sync
