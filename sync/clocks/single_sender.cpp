#include "sync/clocks/single_sender.h"

namespace tactus::sync {

// A sender numbers and stamps its messages in one order. Both counts are >= 0, so the differences do not overflow.
bool SingleSender::impossible(const header_t& h) const {
  if (!repeated(h)) return h.seq - seq_ > kMaxGap;
  return h.publish_time_ns > publish_ns_ || h.publish_time_ns < publish_ns_ - kMaxStepBack.count();
}

SenderStatus SingleSender::accept(const header_t& h, HostTime arrival, SenderStatus status) {
  if (known_ && h.incarnation != incarnation_) former_[next_former_++ % kRemembered] = incarnation_;
  known_ = true;
  incarnation_ = h.incarnation;
  followed_run_ = h.run_id;
  seq_ = h.seq;
  publish_ns_ = h.publish_time_ns;
  contradictions_ = 0;
  last_arrival_ = std::max(last_arrival_, arrival);
  return status;
}

// kCurrent: of the followed sender; nothing is stored yet.
SenderStatus SingleSender::follow(const header_t& h, HostTime arrival) {
  if (run_id_ != kAnyRun && h.run_id != run_id_) return ++foreign_, SenderStatus::kForeign;
  if (known_ && h.incarnation == incarnation_ && h.run_id == followed_run_) return SenderStatus::kCurrent;
  const bool former = std::find(former_.begin(), former_.end(), h.incarnation) != former_.end();
  if (silent_for(former ? std::max(silence_, kSilence) : silence_, arrival)) return accept(h, arrival, SenderStatus::kFirst);
  ++conflicts_;
  last_conflict_ = std::max(last_conflict_, arrival);
  return SenderStatus::kConflict;
}

SenderStatus SingleSender::on_message(const header_t& h, HostTime arrival) {
  const SenderStatus status = follow(h, arrival);
  if (status != SenderStatus::kCurrent) return status;
  if (impossible(h))
    return ++contradictions_ < kMaxContradictions ? SenderStatus::kOld : accept(h, arrival, SenderStatus::kFirst);
  return repeated(h) ? SenderStatus::kOld : accept(h, arrival, SenderStatus::kCurrent);
}

SenderStatus SingleSender::on_page(const header_t& h, HostTime arrival) {
  const SenderStatus status = follow(h, arrival);
  return status == SenderStatus::kCurrent ? accept(h, arrival, status) : status;
}

}  // namespace tactus::sync
