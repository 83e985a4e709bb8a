// The host clock, and loops with absolute deadlines. Beside the mains, clocks are read only here.
#pragma once

#include <cstdint>

#include "sync/time/time.h"

namespace tactus::sync {

// CLOCK_MONOTONIC. Realtime-safe: yes. Thread-safe: yes.
HostTime host_now();

// CLOCK_REALTIME, ns: numbers profiles and requests across restarts of their senders.
std::int64_t realtime_ns();

// The deadlines of a loop, without a clock. Pure: tests set the time.
class Deadlines {
 public:
  Deadlines(double rate_Hz, HostTime start) : start_(start), next_(start) { set_rate(rate_Hz); }

  // From the next deadline on. Throws std::invalid_argument unless 0 < rate_Hz <= 10000.
  void set_rate(double rate_Hz);
  double rate_Hz() const { return rate_Hz_; }

  HostTime next() const { return next_; }
  // Call it after waking for next(). A loop that overslept skips whole periods and counts them; it never catches up in a
  // burst. Returns the number of skipped ticks.
  std::int64_t advance(HostTime now);
  // Re-phases the loop: the next deadline is at `next`, and later ones count from there. The skipped ticks before it count
  // as missed.
  void align(HostTime next, std::int64_t skipped = 0);

  std::int64_t ticks() const { return ticks_; }
  std::int64_t missed() const { return missed_; }

 private:
  HostTime start_;
  HostTime next_;
  double rate_Hz_ = 1;
  std::int64_t since_start_ = 0;  // periods from start_ to next_: deadlines do not drift by rounding
  std::int64_t ticks_ = 0;
  std::int64_t missed_ = 0;
};

// Sleeps until t; returns immediately when t is past. A signal ends the sleep early. Realtime-safe: yes (it only sleeps).
void sleep_until(HostTime t);

// Sleeps on absolute deadlines.
class Loop {
 public:
  explicit Loop(double rate_Hz) : deadlines_(rate_Hz, host_now()) {}

  // Sleeps until the next deadline and returns the clock after waking. A signal ends the sleep early. Realtime-safe: yes (it
  // only sleeps).
  HostTime wait();
  void set_rate(double rate_Hz) { deadlines_.set_rate(rate_Hz); }
  void align(HostTime next, std::int64_t skipped) { deadlines_.align(next, skipped); }

  // Lateness of the last wake-up.
  Nanoseconds wake_lateness() const { return lateness_; }
  const Deadlines& deadlines() const { return deadlines_; }

 private:
  Deadlines deadlines_;
  Nanoseconds lateness_{0};
};

}  // namespace tactus::sync
