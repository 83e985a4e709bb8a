#include "sync/log/log_feed.h"

#include <algorithm>
#include <stdexcept>

#include "sync/bus/bus.h"

namespace tactus::sync {

// Reads the log three times: for its run and its damage, for its end, and for the inboxes.
LogFeed::LogFeed(const std::string& path, double rate_Hz)
    : file_(path),
      whole_(file_.bytes()),
      events_(file_.bytes(), origin_, &ages_),
      period_(from_seconds(1 / rate_Hz)) {
  LogClockDetector finder;
  for (LogEvent event; whole_.next(event);) {
    finder.observe(event);
    ages_.note(bounded_us(event.timestamp_us));
  }
  if (whole_.events() == 0)
    throw std::runtime_error(path + " is no LCM log, or holds not one intact event; give the run.lcmlog of a run");
  origin_ = finder.find();
  if (!origin_.known)
    throw std::runtime_error(path + " holds no message of Tactus; give a run.lcmlog that scripts/run wrote");
  TimestampedEvents again(file_.bytes(), origin_, &ages_);
  bool begun = false;
  HostTime at{};
  for (LogEvent event; again.next(event, at);) {
    if (!begun && !ages_.of_the_run(bounded_us(event.timestamp_us))) continue;
    if (!begun) begin_ = end_ = at;
    begun = true;
    end_ = std::max(end_, at);
  }
  events_.start_at(0, begin_);
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
    if (!left_out_.contains(pending_.channel)) bus.hear(pending_.channel, pending_.data, pending_at_);
    has_pending_ = false;
  }
  return now_;
}

}  // namespace tactus::sync
