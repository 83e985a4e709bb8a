#include "sync/clock_sync/offset_tracker.h"

#include <algorithm>
#include <cmath>

namespace tactus::sync {
namespace {
double ns(Nanoseconds t) { return static_cast<double>(t.count()); }
}  // namespace

OffsetSample probe_sample(HostTime sent, HostTime remote_arrival, HostTime remote_reply, HostTime returned) {
  const Nanoseconds max_offset = remote_arrival - sent, min_offset = remote_reply - returned;
  const Nanoseconds round_trip = returned - sent;
  OffsetSample s;
  s.at = sent + round_trip / 2;
  s.offset = min_offset + (max_offset - min_offset) / 2;
  // The two bounds belong to two instants, and the clocks drift in between. Halving rounds by 1 ns.
  s.half_width = (max_offset - min_offset) / 2 + OffsetTracker::kGranularity +
                 Nanoseconds(static_cast<std::int64_t>(ns(round_trip) * OffsetTracker::kMaxDrift) + 1);
  return s;
}

OffsetTracker::Interval OffsetTracker::relative(const OffsetSample& s) const {
  const double middle = ns(s.offset - base_);
  return {middle - ns(s.half_width), middle + ns(s.half_width)};
}

OffsetTracker::Interval OffsetTracker::aged(HostTime t, Rate rate) const {
  const double since = ns(t - at_);
  if (since >= 0) return {interval_.low + since * rate.low, interval_.high + since * rate.high};
  return {interval_.low + since * rate.high, interval_.high + since * rate.low};
}

OffsetTracker::Rate OffsetTracker::widened_rate() const {
  return {std::max(rate_.low - kRateTolerance, -kMaxDrift), std::min(rate_.high + kRateTolerance, kMaxDrift)};
}

void OffsetTracker::begin(const OffsetSample& s) {
  known_ = true;
  base_ = s.offset;
  at_ = s.at;
  interval_ = relative(s);
  rate_ = {};
  measured_ = {{at_, interval_}};
  has_line_ = false;
}

OffsetTracker::Outcome OffsetTracker::add(const OffsetSample& s) {
  if (!known_) return begin(s), Outcome::kFirst;
  const Interval measured = relative(s);
  const auto intersection = [&](Rate rate) {
    const Interval before = aged(s.at, rate);
    return Interval{std::max(before.low, measured.low), std::min(before.high, measured.high)};
  };
  Outcome outcome = Outcome::kNarrowed;
  Interval agreed = intersection(widened_rate());
  if (agreed.empty()) {
    outcome = Outcome::kRateChanged;
    rate_ = {};
    measured_.clear();
    agreed = intersection(rate_);
  }
  if (agreed.empty()) {
    ++epoch_;
    return begin(s), Outcome::kJumped;
  }
  at_ = s.at;
  interval_ = agreed;
  measured_.push_back({s.at, measured});
  if (measured_.size() > kRemembered) measured_.pop_front();
  measure_rate();
  return outcome;
}

void OffsetTracker::measure_rate() {
  const Measured& newest = measured_.back();
  Rate rate;
  for (const Measured& m : measured_) {
    if (newest.at - m.at < kMinBase) continue;
    const double base = ns(newest.at - m.at);
    rate.low = std::max(rate.low, (newest.interval.low - m.interval.high) / base);
    rate.high = std::min(rate.high, (newest.interval.high - m.interval.low) / base);
  }
  if (rate.low <= rate.high) {
    rate_ = rate;
    return;
  }
  // No single rate fits: it has changed within the half minute.
  rate_ = {};
  measured_ = {newest};
}

OffsetLine OffsetTracker::line(HostTime now) {
  const Rate rate = widened_rate();
  const Interval interval = aged(now, rate);
  const double middle = (interval.low + interval.high) / 2;
  double value = middle;
  if (has_line_) value = ns(line_.offset - base_) + ns(now - line_.at) * line_.drift;
  OffsetLine next;
  next.at = now;
  next.offset = base_ + Nanoseconds(std::llround(value));
  value = ns(next.offset - base_);
  next.drift = (rate_.low + rate_.high) / 2 + std::clamp((middle - value) / ns(kSlewTime), -kMaxSlew, kMaxSlew);
  next.uncertainty = Nanoseconds(static_cast<std::int64_t>(std::max(interval.high - value, value - interval.low)) + 1);
  next.uncertainty_drift = std::max({rate.high - next.drift, next.drift - rate.low, 0.0});
  next.epoch = epoch_;
  line_ = next;
  has_line_ = true;
  return next;
}

}  // namespace tactus::sync
