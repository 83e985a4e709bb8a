#include "sync/log_feed.h"

#include <stdexcept>

namespace tactus::sync {

// Twice through the log: once to know its run, its end and its damage, once to hand it over.
LogFeed::LogFeed(const std::string& path, double rate_Hz)
    : file_(path), whole_(file_.bytes()), scanner_(file_.bytes()), period_(from_seconds(1 / rate_Hz)) {
  bool told = false;
  for (LogEvent event; whole_.next(event);) {
    if (!told && event.channel == channels::kLogInfo) {
      if (const auto info = decode<log_info_t>(event.data.data(), event.data.size())) {
        info_ = *info, told = true;
        begin_ = arrival(event);
      }
    }
    if (told) end_ = std::max(begin_, arrival(event));
  }
  if (whole_.events() == 0)
    throw std::runtime_error(path + " is no LCM log, or holds not one intact event; give the run.lcmlog of a run");
  if (!told)
    throw std::runtime_error(path + " does not say which run it is (no LOG_INFO); give a run.lcmlog that scripts/run wrote");
  clock_ = {};
  now_ = begin_ - period_;
}

BusOptions LogFeed::bus() const {
  BusOptions options;
  options.memory = true;
  options.clock = clock();
  return options;
}

HostTime LogFeed::arrival(const LogEvent& event) {
  return clock_.observe(host_time(event.timestamp_us * 1000 - info_.realtime_offset_ns));
}

HostTime LogFeed::next(Bus& bus) {
  now_ += period_;
  for (;;) {
    if (!has_pending_ && !scanner_.next(pending_)) break;
    has_pending_ = true;
    const HostTime at = arrival(pending_);
    if (at > now_) break;
    bus.hear(pending_.channel, pending_.data, at);
    has_pending_ = false;
  }
  return now_;
}

}  // namespace tactus::sync
