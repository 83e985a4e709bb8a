#include "thermal_node/devices/one_sender.h"

#include <algorithm>

namespace tactus::thermal {
namespace {

// Largest difference of the rates of two clocks, as a fraction 1/kDrift. Design: quartz is within 1e-4.
constexpr std::int64_t kDrift = 1000;

}  // namespace

OneSender::Result OneSender::observe(const header_t& h, sync::HostTime arrival) {
  const bool gone = silent(arrival);
  const bool same = used_ && h.source == source_ && h.incarnation == incarnation_;
  if (!same && !gone) {
    other_ = arrival;
    return Result::kOther;
  }
  if (same && !gone && h.seq <= seq_) return Result::kRepeated;
  if (gone) latency_.reset();
  const sync::Nanoseconds late = lateness(h, arrival);
  if (late > silence_) return Result::kLate;
  if (late < -kMaxAhead) {
    ahead_ = arrival;
    return Result::kAhead;
  }
  if (gone) since_ = arrival;
  if (!same) ++followed_;
  source_ = h.source;
  incarnation_ = h.incarnation;
  seq_ = h.seq;
  used_ = arrival;
  return gone ? Result::kRestart : Result::kUse;
}

// The clock of another machine has an unknown offset, so its messages are compared with its earlier ones. Their
// latency differs by the jitter of a network, for which `silence` is enough.
sync::Nanoseconds OneSender::lateness(const header_t& h, sync::HostTime arrival) {
  const sync::Nanoseconds latency = arrival - sync::host_time(h.publish_time_ns);
  if (clock_ != 0 && h.clock == clock_) return latency;
  if (!latency_) latency_ = latency, latency_at_ = arrival;
  const sync::Nanoseconds least = *latency_ + (arrival - latency_at_) / kDrift;
  const sync::Nanoseconds late = latency - least;
  if (std::chrono::abs(late) > silence_) return late;
  latency_ = std::min(latency, least);
  latency_at_ = arrival;
  return std::max(late, sync::Nanoseconds(0));
}

}  // namespace tactus::thermal
