// Real-time scheduling of this process, as an explicit choice, and the guard that keeps a real-time loop from starving the
// machine.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

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
// Sets SCHED_FIFO at this priority for this thread only. False when it is refused. Realtime-safe: yes.
bool set_fifo(int priority);

// Whether mlockall(MCL_FUTURE) holds for every later allocation: when memory locking has no limit, or when the process holds
// CAP_IPC_LOCK, which lifts the limit. The capability of a user namespace does not lift it (user_namespaces(7)).
// effective_capabilities: bits as in capabilities(7); uid_map: text of /proc/self/uid_map. Pure.
bool can_lock_all_memory(bool limited, std::uint64_t effective_capabilities, std::string_view uid_map);

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

// Decides when a FIFO loop gives up its priority, by OverrunGuard, and when it returns to it: after 10 s without overload. Pure.
class PriorityKeeper {
 public:
  enum class Change { kNone, kLeave, kReturn };
  // One tick: its begin, its end, and the earliest begin of the next.
  Change tick(HostTime begin, HostTime end);
  bool demoted() const { return demoted_; }

 private:
  static constexpr Nanoseconds kPromoteAfter{10'000'000'000};
  OverrunGuard guard_;
  bool demoted_ = false;
};

// Applies PriorityKeeper to a thread that inherits the scheduling of its creator. Realtime-safe: yes.
class FifoThread {
 public:
  // Call first, on the thread. Under FIFO it takes this priority; 0: it keeps its own. Otherwise it stays normal.
  // Returns whether it runs under FIFO.
  bool enter(int priority);
  // Call on the thread after each tick.
  void tick(HostTime begin, HostTime end);

 private:
  PriorityKeeper keeper_;
  bool fifo_ = false;
  int priority_ = 0;
};

}  // namespace tactus::sync
