// Real-time scheduling of this process, as an explicit choice, and the guard that keeps a real-time loop from starving the
// machine.
#pragma once

#include <string>

#include "sync/time/time.h"

namespace tactus::sync {

enum class Realtime { kRequire, kTry, kOff };

// Sets SCHED_FIFO at this priority and locks memory, for this thread and the threads that it starts. Returns one line with
// the obtained scheduling. Throws std::runtime_error with the remedy when real-time is required and refused. priority 0:
// normal scheduling.
std::string set_realtime(Realtime choice, int priority);

// Returns this thread to normal scheduling.
void leave_realtime();
bool is_realtime();

// Detects a FIFO loop that uses more than 80 % of its time for 100 ms and must give up its priority. Pure.
class OverrunGuard {
 public:
  // One tick: its begin, its end, and the earliest begin of the next. Returns true when the loop must be demoted.
  bool tick(HostTime begin, HostTime end);
  // Time without a break below that load.
  Nanoseconds time_below_limit() const { return time_below_limit_; }

 private:
  static constexpr Nanoseconds kWindow{100'000'000};
  static constexpr double kMaxBusy = 0.8;
  HostTime window_begin_{};
  Nanoseconds busy_{0};
  Nanoseconds time_below_limit_{0};
};

}  // namespace tactus::sync
