#include "sync/node/realtime.h"

#include <sched.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/resource.h>

#include <cerrno>
#include <stdexcept>

namespace tactus::sync {
namespace {

std::string remedy(int priority) {
  return "allow it with scripts/setup --realtime (rtprio " + std::to_string(priority) +
         " in /etc/security/limits.d), or start with --realtime try";
}

// Memory locking is refused to processes with a small limit. A page fault may then cost a tick; the status line reports it.
bool lock_memory() { return mlockall(MCL_CURRENT | MCL_FUTURE) == 0; }

bool may_lock_all() {
  rlimit limit{};
  getrlimit(RLIMIT_MEMLOCK, &limit);
  return limit.rlim_cur == RLIM_INFINITY;
}

}  // namespace

std::string set_realtime(Realtime choice, int priority) {
  if (choice == Realtime::kOff || priority <= 0) return "normal scheduling";
  sched_param param{};
  param.sched_priority = priority;
  if (sched_setscheduler(0, SCHED_FIFO, &param) != 0) {
    const std::string reason = strerror(errno);
    if (choice == Realtime::kRequire)
      throw std::runtime_error("SCHED_FIFO " + std::to_string(priority) + " is refused (" + reason +
                               "): " + remedy(priority));
    return "normal scheduling (SCHED_FIFO refused: " + reason + ")";
  }
  // A limited mlockall(MCL_FUTURE) makes later allocations fail, so it is only tried without a limit.
  const bool locked = may_lock_all() && lock_memory();
  return "SCHED_FIFO " + std::to_string(priority) + (locked ? ", memory locked" : ", memory not locked");
}

void leave_realtime() {
  sched_param param{};
  sched_setscheduler(0, SCHED_OTHER, &param);
}

bool is_realtime() { return sched_getscheduler(0) == SCHED_FIFO; }

bool OverrunGuard::tick(HostTime begin, HostTime end) {
  if (window_begin_ == HostTime{}) window_begin_ = begin;
  busy_ += end - begin;
  const Nanoseconds span = end - window_begin_;
  if (span < kWindow) return false;
  const bool too_busy = to_seconds(busy_) > kMaxBusy * to_seconds(span);
  time_below_limit_ = too_busy ? Nanoseconds(0) : time_below_limit_ + span;
  window_begin_ = end;
  busy_ = Nanoseconds(0);
  return too_busy;
}

}  // namespace tactus::sync
