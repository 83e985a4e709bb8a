#include "sync/relay/newest_message.h"

namespace tactus::sync {
namespace {

constexpr std::int64_t kClockStep_ns = 1'000'000'000;  // a clock that falls back by more was wrong before, or is another one

bool is_newer(const header_t& h, const header_t& than) { return h.seq > than.seq || h.publish_time_ns > than.publish_time_ns; }

}  // namespace

bool NewestMessage::is_old(const header_t& h, HostTime arrival) {
  const bool old = newest_ && !is_newer(h, *newest_) && newest_->publish_time_ns - h.publish_time_ns <= kClockStep_ns;
  if (!old) {
    newest_ = h;
    run_.reset();
    return false;
  }
  const bool repeated = h.seq == newest_->seq && h.publish_time_ns == newest_->publish_time_ns;
  if (repeated || (run_ && !is_newer(h, run_->last))) return true;
  if (!run_) run_ = Run{arrival, h};
  run_->last = h;
  if (arrival - run_->begin < patience_) return true;
  newest_ = h;
  run_.reset();
  return false;
}

}  // namespace tactus::sync
