// Replaces the bus by a log: passes the recorded messages to the inboxes, each at the first tick after the recorder's stamp, as
// a node reads the bus. A node then renders the log as it would have rendered the run, as fast as it can. Pure, except that it maps the file.
#pragma once

#include <cstdint>
#include <functional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "sync/bus/bus_options.h"
#include "sync/log/timestamped_events.h"
#include "sync/log/log_index.h"
#include "sync/log/mapped_log.h"

namespace tactus::sync {

class Bus;

class LogFeed {
 public:
  // rate_Hz: of the ticks. run: its number among the runs of the log, from 1. Throws std::runtime_error with one sentence when
  // the file holds no message of a run, or no such run.
  LogFeed(const std::string& path, double rate_Hz, int run = 1);

  // Run and clock of the recorder: a node in that run converts the simulation's times as a node on the recorder's host would.
  std::int64_t run_id() const { return origin().info.header.run_id; }
  std::int32_t clock() const { return origin().info.header.clock; }
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
    return {index_, run_};
  }

  HostTime begin() const { return begin_; }
  HostTime end() const { return end_; }
  // Totals of the whole log.
  std::int64_t events() const { return index_.events(); }
  std::int64_t damaged_regions() const { return index_.damaged_regions(); }
  std::int64_t damaged_bytes() const { return index_.damaged_bytes(); }
  // Events of the run with damaged stamps. They are passed on with the event before them, and do not lengthen the run.
  std::int64_t misdated() const { return index_.run(run_).misdated; }
  // One sentence when the log does not state its run, or states it wrongly; empty otherwise.
  const std::string& recovered() const { return origin().recovered; }
  // Sentences about other runs in the log, jumps of the recorder's clock and copies of messages.
  std::vector<std::string> warnings() const { return index_.warnings(run_); }

 private:
  const LogOrigin& origin() const { return index_.run(run_).origin; }

  MappedLog file_;
  LogIndex index_;
  int run_;
  std::set<std::string, std::less<>> excluded_;
  TimestampedEvents events_;
  LogEvent pending_;
  HostTime pending_at_{};
  bool has_pending_ = false;
  HostTime begin_{}, end_{}, now_{};
  Nanoseconds period_;
};

}  // namespace tactus::sync
