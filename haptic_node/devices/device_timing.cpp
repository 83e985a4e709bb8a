#include "haptic_node/devices/device_timing.h"

#include <algorithm>
#include <cmath>

namespace tactus::haptic {
namespace {

// Time constant of the peaks: longer than a swing of a hand at 2 Hz, so that the stiffness does not follow single
// late states up and down; as of the peak of the loop delay (coupling.h). Design.
constexpr double kPeakDecay_s = 1;
// Time constant of the means: several states at 50 Hz. Design.
constexpr double kMean_s = 0.1;
// Fastest plausible device, s: four times the rate limit of the servo loop. Design.
constexpr double kMinInterval_s = 0.0625e-3;
// A force that arrives this share of an interval after a state still counts as being in time for it: rounding, not
// luck.
constexpr double kInTime = 0.02;

double bounded(double seconds, double low) { return std::clamp(seconds, low, DeviceTiming::kMax_s); }

}  // namespace

void DeviceTiming::restart() { *this = DeviceTiming(at_once_); }

void DeviceTiming::on_state(std::int64_t stamp_ns, double transit_s, sync::HostTime arrival) {
  const double transit = bounded(transit_s, 0);
  if (known_) {
    const double interval = bounded(1e-9 * static_cast<double>(stamp_ns - stamp_ns_), kMinInterval_s);
    const double follow = 1 - std::exp(-interval / kMean_s);
    interval_s_ = interval_s_ > 0 ? interval_s_ + follow * (interval - interval_s_) : interval;
    transit_s_ += follow * (transit - transit_s_);
    longest_interval_s_ = std::max(longest_interval_s_, interval);
    last_interval_s_ = interval;
  } else {
    transit_s_ = transit;
  }
  known_ = fresh_ = true;
  stamp_ns_ = stamp_ns;
  arrival_ = arrival;
  measured_ = arrival - sync::from_seconds(transit);
}

// The first tick with a new state: from when on its force will act.
void DeviceTiming::measure_use(sync::HostTime now) {
  double delay = sync::to_seconds(now - measured_) + transit_s_;
  const double interval = std::max(interval_s_, last_interval_s_);
  if (!at_once_ && interval > 0) delay = interval * std::max(1.0, std::ceil(delay / interval - kInTime));
  // Decays from state to state, so that the value of a steady driver is constant.
  delay_s_ = std::max(delay_s_ * std::exp(-interval_s_ / kPeakDecay_s), bounded(delay, 0));
}

DeviceLoop DeviceTiming::step(sync::HostTime now) {
  if (!known_) return {};
  const double passed = last_step_ > sync::HostTime{} ? std::max(0.0, sync::to_seconds(now - last_step_)) : 0;
  last_step_ = now;
  const double decay = std::exp(-passed / kPeakDecay_s);
  const double gap_s = bounded(sync::to_seconds(now - arrival_), kMinInterval_s);
  longest_interval_s_ = std::max({interval_s_, longest_interval_s_ * decay, gap_s});
  if (!at_once_ && interval_s_ > 0) delay_s_ = std::max(delay_s_, gap_s);
  DeviceLoop loop;
  if (fresh_) {
    measure_use(now);
    if (used_) loop.span_s = bounded(1e-9 * static_cast<double>(stamp_ns_ - used_stamp_ns_), 0);
    used_stamp_ns_ = stamp_ns_;
    used_ = true;
    fresh_ = false;
  }
  loop.period_s = bounded(longest_interval_s_, kMinInterval_s);
  loop.interval_s = interval_s_ > 0 ? interval_s_ : loop.period_s;
  loop.age_s = std::max(0.0, sync::to_seconds(now - measured_));
  loop.force_delay_s = transit_s_;
  loop.delay_s = delay_s_;
  loop.at_once = at_once_;
  return loop;
}

}  // namespace tactus::haptic
