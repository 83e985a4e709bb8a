#include "sync/log/log_feed.h"

#include <algorithm>
#include <stdexcept>

#include "sync/bus/bus.h"

namespace tactus::sync {

// Reads the log three times: for its run and its damage, for its end, and for the inboxes.
LogFeed::LogFeed(const std::string& path, double rate_Hz)
    : file_(path),
      scan_(file_.bytes()),
      events_(file_.bytes(), origin_, &time_ranges_),
      period_(from_seconds(1 / rate_Hz)) {
  LogClockDetector detector;
  for (LogEvent event; scan_.next(event);) {
    detector.observe(event);
    time_ranges_.add(bounded_us(event.timestamp_us));
  }
  if (scan_.events() == 0)
    throw std::runtime_error(path +
                             " is not an LCM log, or contains no intact event; give the run.lcmlog of a run");
  origin_ = detector.find();
  if (!origin_.known)
    throw std::runtime_error(path + " holds no message of Tactus; give a run.lcmlog that scripts/run wrote");
  TimestampedEvents events(file_.bytes(), origin_, &time_ranges_);
  bool started = false;
  HostTime at{};
  for (LogEvent event; events.next(event, at);) {
    if (!started && !time_ranges_.in_run(bounded_us(event.timestamp_us))) continue;
    if (!started) begin_ = end_ = at;
    started = true;
    end_ = std::max(end_, at);
  }
  events_.seek(0, begin_);
  now_ = begin_ - period_;
}

BusOptions LogFeed::bus() const {
  BusOptions options;
  options.memory = true;
  options.clock = clock();
  return options;
}

HostTime LogFeed::next_at(Bus& bus, HostTime tick) {
  now_ = std::max(now_, tick);
  for (;;) {
    if (!has_pending_ && !events_.next(pending_, pending_at_)) break;
    has_pending_ = true;
    if (pending_at_ > now_) break;
    // A message arrives at the tick that reads it, as from the bus: ages then have the same values as in the run.
    if (!excluded_.contains(pending_.channel)) bus.on_message(pending_.channel, pending_.data, now_);
    has_pending_ = false;
  }
  return now_;
}

}  // namespace tactus::sync
