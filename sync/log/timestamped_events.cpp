#include "sync/log/timestamped_events.h"

namespace tactus::sync {

void TimestampedEvents::start_at(std::size_t at, HostTime from) {
  scanner_.start_at(at);
  clock_ = {};
  clock_.observe(from);
  before_ = from;
  ahead_.reset();
  begun_ = false;
}

HostTime TimestampedEvents::time_of(const LogEvent& event) {
  if (!credible(event)) return before_.value_or(origin_.time(event.timestamp_us));
  const HostTime stamp = origin_.time(event.timestamp_us);
  if (before_ && ahead_ && credible(*ahead_)) {
    // Recorders stamp in order: a stamp that the next event contradicts, and the previous one does not support, is wrong.
    const HostTime next = origin_.time(ahead_->timestamp_us);
    if (*before_ <= next && next < stamp) return *before_;
  }
  before_ = clock_.observe(stamp);
  return *before_;
}

bool TimestampedEvents::next(LogEvent& event, HostTime& time) {
  const auto read = [&] {
    LogEvent e;
    ahead_ = scanner_.next(e) ? std::optional(e) : std::nullopt;
  };
  if (!begun_) read();
  begun_ = true;
  if (!ahead_) return false;
  event = *ahead_;
  read();
  time = time_of(event);
  return true;
}

}  // namespace tactus::sync
