#include "thermal_node/devices/dated_sender.h"

#include <algorithm>

namespace tactus::thermal {
namespace {

// Largest difference of the rates of two clocks, as a fraction 1/kDrift. Design: quartz is within 1e-4.
constexpr std::int64_t kDrift = 1000;

}  // namespace

DatedSender::Result DatedSender::observe(const header_t& h, sync::HostTime arrival) {
  const bool gone = silent(arrival);
  // The clock of this process has stepped back: nothing of the future counts.
  if (used_ && arrival < *used_ - silence_) sender_ = sync::SingleSender(run_id_, silence_);
  // A message with a false date does not make its sender the followed one, and does not keep it alive.
  sync::SingleSender next = sender_;
  const bool other = !used_ || h.incarnation != incarnation_, restarts = gone || other;
  const sync::SenderStatus status = next.on_message(h, arrival);
  if (!sync::accepted(status)) {
    sender_ = next;
    return status == sync::SenderStatus::kConflict  ? Result::kOther
           : status == sync::SenderStatus::kForeign ? Result::kForeign
                                                    : Result::kRepeated;
  }
  if (restarts) latency_.reset();
  const sync::Nanoseconds late = lateness(h, arrival);
  if (late > silence_) return Result::kLate;
  if (late < -kMaxAhead) {
    ahead_ = arrival;
    return Result::kAhead;
  }
  sender_ = next;
  // Its numbers contradicted an earlier one, which was false; repetitions with new dates look the same, so this one is not used.
  if (!restarts && status == sync::SenderStatus::kFirst) return Result::kRepeated;
  if (restarts) since_ = arrival;
  if (other) ++followed_;
  incarnation_ = h.incarnation;
  used_ = arrival;
  return restarts ? Result::kRestart : Result::kUse;
}

// The clock of another machine has an unknown offset, so its messages are compared with its earlier ones. Their
// latency differs by the jitter of a network, for which `silence` is enough.
sync::Nanoseconds DatedSender::lateness(const header_t& h, sync::HostTime arrival) {
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
