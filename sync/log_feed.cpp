#include "sync/log_feed.h"

#include <algorithm>
#include <stdexcept>

namespace tactus::sync {

// Three times through the log: to know its run and its damage, to know its end, and to hand it over.
LogFeed::LogFeed(const std::string& path, double rate_Hz)
    : file_(path), whole_(file_.bytes()), scanner_(file_.bytes()), period_(from_seconds(1 / rate_Hz)) {
  bool told = false;
  std::vector<Age> ages;
  const auto note = [&](HostTime t) {
    for (Age& a : ages) {
      if (t < a.first - SummaryClock::kLargestStep || t > a.last + SummaryClock::kLargestStep) continue;
      a.first = std::min(a.first, t), a.last = std::max(a.last, t), ++a.events;
      return;
    }
    ages.push_back({t, t, 1});
  };
  for (LogEvent event; whole_.next(event);) {
    if (!told && event.channel == channels::kLogInfo) {
      if (const auto info = decode<log_info_t>(event.data.data(), event.data.size())) {
        info_ = *info, told = true;
        begin_ = arrived_ = stamp(event);
      }
    }
    if (told) note(stamp(event));
  }
  if (whole_.events() == 0)
    throw std::runtime_error(path + " is no LCM log, or holds not one intact event; give the run.lcmlog of a run");
  if (!told)
    throw std::runtime_error(path +
                             " does not say which run it is (its LOG_INFO is missing or damaged); give a "
                             "run.lcmlog that scripts/run wrote, whole "
                             "at its beginning");
  // The first is that of the run's name.
  for (std::size_t i = 1; i < ages.size(); ++i)
    if (ages[i].events < kFewestOfARun) damaged_ages_.push_back(ages[i]);
  LogScanner again(file_.bytes());
  for (LogEvent event; again.next(event);) end_ = std::max(begin_, arrival(event));
  clock_ = {};
  arrived_ = begin_;
  now_ = begin_ - period_;
}

BusOptions LogFeed::bus() const {
  BusOptions options;
  options.memory = true;
  options.clock = clock();
  return options;
}

std::int64_t LogFeed::misdated() const {
  std::int64_t events = 0;
  for (const Age& a : damaged_ages_) events += a.events;
  return events;
}

HostTime LogFeed::stamp(const LogEvent& event) const {
  constexpr std::int64_t kMost_us = 4'000'000'000'000'000;  // the year 2096: in ns it is still a number
  return host_time(std::clamp(event.timestamp_us, -kMost_us, kMost_us) * 1000 - info_.realtime_offset_ns);
}

HostTime LogFeed::arrival(const LogEvent& event) {
  const HostTime t = stamp(event);
  const auto within = [&](const Age& a) { return a.first <= t && t <= a.last; };
  if (std::any_of(damaged_ages_.begin(), damaged_ages_.end(), within)) return arrived_;
  return arrived_ = clock_.observe(t);
}

HostTime LogFeed::next_at(Bus& bus, HostTime tick) {
  now_ = std::max(now_, tick);
  for (;;) {
    if (!has_pending_ && !scanner_.next(pending_)) break;
    has_pending_ = true;
    const HostTime at = arrival(pending_);
    if (at > now_) break;
    if (!left_out_.contains(pending_.channel)) bus.hear(pending_.channel, pending_.data, at);
    has_pending_ = false;
  }
  return now_;
}

}  // namespace tactus::sync
