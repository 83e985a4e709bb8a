#include "sync/log/timestamped_events.h"

namespace tactus::sync {

void TimestampedEvents::seek(std::size_t at, HostTime from) {
  scanner_.seek(at);
  clock_ = {};
  clock_.observe(from);
  before_ = from;
  lookahead_.reset();
  started_ = false;
}

HostTime TimestampedEvents::time_of(const LogEvent& event) {
  if (!plausible(event)) return before_.value_or(origin_.time(event.timestamp_us));
  const HostTime stamp = origin_.time(event.timestamp_us);
  if (before_ && lookahead_ && plausible(*lookahead_)) {
    // The stamps of a recorder never decrease. A stamp above the next one is wrong if the previous and the next stamp are in
    // order.
    const HostTime next = origin_.time(lookahead_->timestamp_us);
    if (*before_ <= next && next < stamp) return *before_;
  }
  before_ = clock_.observe(stamp);
  return *before_;
}

bool TimestampedEvents::next(LogEvent& event, HostTime& time) {
  const auto read = [&] {
    LogEvent e;
    lookahead_ = scanner_.next(e) ? std::optional(e) : std::nullopt;
  };
  if (!started_) read();
  started_ = true;
  if (!lookahead_) return false;
  event = *lookahead_;
  read();
  time = time_of(event);
  return true;
}

}  // namespace tactus::sync
