// Real-time scheduling of this process, as an explicit choice, and the guard that keeps it from starving the
// machine.
#pragma once

#include <string>

#include "sync/time/time.h"

namespace tactus::sync {

enum class Realtime { kRequire, kTry, kOff };

// SCHED_FIFO at this priority and locked memory, for this thread and those that it starts. Returns one line that
// says what was obtained. Throws std::runtime_error with the remedy when it is required and refused. priority 0:
// normal.
std::string set_realtime(Realtime choice, int priority);

// Puts this thread back to normal scheduling.
void leave_realtime();
bool is_realtime();

// A FIFO loop that uses more than 80 % of its time for 100 ms must give up its priority. Pure.
class OverrunGuard {
 public:
  // One tick: when it began, when it ended, and when the next may begin. True when the loop must be demoted.
  bool tick(HostTime begin, HostTime end);
  // How long it has kept below that without a break.
  Nanoseconds calm() const { return calm_; }

 private:
  static constexpr Nanoseconds kWindow{100'000'000};
  static constexpr double kMaxBusy = 0.8;
  HostTime window_begin_{};
  Nanoseconds busy_{0};
  Nanoseconds calm_{0};
};

}  // namespace tactus::sync
