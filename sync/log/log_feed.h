// Replaces the bus by a log: passes the recorded messages to the inboxes, each at the first tick after the recorder's stamp, as
// a node reads the bus. A node then renders the log as it would have rendered the run, as fast as it can. Pure, except that it maps the file.
#pragma once

#include <cstdint>
#include <functional>
#include <set>
#include <string>
#include <utility>

#include "sync/bus/bus_options.h"
#include "sync/log/timestamped_events.h"
#include "sync/log/log_time_ranges.h"
#include "sync/log/log_origin.h"
#include "sync/log/log_reader.h"
#include "sync/log/mapped_log.h"

namespace tactus::sync {

class Bus;

class LogFeed {
 public:
  // rate_Hz: of the ticks. Throws std::runtime_error with one sentence when the file holds no message of a run.
  LogFeed(const std::string& path, double rate_Hz);

  // Run and clock of the recorder: a node in that run converts the simulation's times as a node on the recorder's host would.
  std::int64_t run_id() const { return origin_.info.header.run_id; }
  std::int32_t clock() const { return origin_.info.header.clock; }
  // Bus options for that node: in memory, with the run and the clock of the log.
  BusOptions bus() const;

  // Messages on this channel are left out from now on.
  void exclude(std::string channel) { excluded_.insert(std::move(channel)); }
  // The next tick: passes every message that had arrived by then to the inboxes. Returns its time, CLOCK_MONOTONIC of the
  // recorder.
  HostTime next(Bus& bus) { return next_at(bus, now_ + period_); }
  // The same for a loop with uneven ticks: the next one is at `tick`, not before the last.
  HostTime next_at(Bus& bus, HostTime tick);
  // True when all messages have been passed on and the time `after` has passed since.
  bool over(Nanoseconds after) const { return now_ >= end_ + after; }

  // All events again from the beginning, for look-ahead. Refers to this object.
  TimestampedEvents from_begin() const {
    TimestampedEvents events(file_.bytes(), origin_, &time_ranges_);
    events.seek(0, begin_);
    return events;
  }

  HostTime begin() const { return begin_; }
  HostTime end() const { return end_; }
  // Totals of the whole log.
  std::int64_t events() const { return scan_.events(); }
  std::int64_t damaged_regions() const { return scan_.damaged_regions(); }
  std::int64_t damaged_bytes() const { return scan_.damaged_bytes(); }
  // Events with damaged stamps: further than LogTimeRanges::kMaxGap_us from the stamps of the run, and too few to be a later
  // part of it. They are passed on with the event before them, and do not lengthen the run.
  std::int64_t misdated() const { return time_ranges_.misdated(); }
  // One sentence when the log does not state its run, or states it wrongly; empty otherwise.
  const std::string& recovered() const { return origin_.recovered; }

 private:
  MappedLog file_;
  std::set<std::string, std::less<>> excluded_;
  LogScanner scan_;
  LogTimeRanges time_ranges_;
  LogOrigin origin_;
  TimestampedEvents events_;
  LogEvent pending_;
  HostTime pending_at_{};
  bool has_pending_ = false;
  HostTime begin_{}, end_{}, now_{};
  Nanoseconds period_;
};

}  // namespace tactus::sync
