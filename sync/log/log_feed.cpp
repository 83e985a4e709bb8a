#include "sync/log/log_feed.h"

#include <algorithm>
#include <stdexcept>

#include "sync/bus/bus.h"

namespace tactus::sync {

namespace {

LogIndex whole_index(std::span<const std::uint8_t> bytes) {
  LogIndex index(bytes);
  index.read_all();
  return index;
}

// Throws std::runtime_error with one sentence.
int checked_run(const LogIndex& index, const std::string& path, int run) {
  if (index.events() == 0)
    throw std::runtime_error(path +
                             " is not an LCM log, or contains no intact event; give the run.lcmlog of a run");
  try {
    if (index.run(run).origin.known) return run;
  } catch (const std::runtime_error& e) {
    throw std::runtime_error(path + " " + e.what());
  }
  throw std::runtime_error(path + " holds no message of Tactus; give a run.lcmlog that scripts/run wrote");
}

}  // namespace

// Reads the log twice: for its runs, times and damage, and for the inboxes.
LogFeed::LogFeed(const std::string& path, double rate_Hz, int run)
    : file_(path),
      index_(whole_index(file_.bytes())),
      run_(checked_run(index_, path, run)),
      events_(index_, run_),
      period_(from_seconds(1 / rate_Hz)) {
  begin_ = origin().time(index_.run(run_).first_us);
  end_ = origin().time(index_.run(run_).last_us);
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
