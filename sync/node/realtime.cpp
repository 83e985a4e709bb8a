#include "sync/node/realtime.h"

#include <linux/capability.h>
#include <sched.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace tactus::sync {
namespace {

std::string remedy(int priority) {
  return "allow it with scripts/setup --realtime (rtprio " + std::to_string(priority) +
         " in /etc/security/limits.d), or start with --realtime try";
}

// Memory locking is refused to processes with a small limit. A page fault may then cost a tick; the status line reports it.
bool lock_memory() { return mlockall(MCL_CURRENT | MCL_FUTURE) == 0; }

// Of this process, as bits; 0 when the kernel does not answer.
std::uint64_t effective_capabilities() {
  __user_cap_header_struct header{_LINUX_CAPABILITY_VERSION_3, 0};
  __user_cap_data_struct data[_LINUX_CAPABILITY_U32S_3]{};
  if (syscall(SYS_capget, &header, data) != 0) return 0;
  return data[0].effective | static_cast<std::uint64_t>(data[1].effective) << 32;
}

bool may_lock_all() {
  rlimit limit{};
  getrlimit(RLIMIT_MEMLOCK, &limit);
  std::ostringstream uid_map;
  uid_map << std::ifstream("/proc/self/uid_map").rdbuf();
  return can_lock_all_memory(limit.rlim_cur != RLIM_INFINITY, effective_capabilities(), uid_map.str());
}

}  // namespace

bool can_lock_all_memory(bool limited, std::uint64_t capabilities, std::string_view uid_map) {
  if (!limited) return true;
  if (!(capabilities >> CAP_IPC_LOCK & 1)) return false;
  // The initial user namespace maps all identifiers to themselves.
  std::istringstream map{std::string(uid_map)};
  std::uint64_t inside = 1, outside = 1, count = 0;
  return map >> inside >> outside >> count && inside == 0 && outside == 0 && count == UINT32_MAX;
}

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
  // A limited mlockall(MCL_FUTURE) makes later allocations fail, so it is only tried when no limit applies.
  const bool locked = may_lock_all() && lock_memory();
  return "SCHED_FIFO " + std::to_string(priority) + (locked ? ", memory locked" : ", memory not locked");
}

void leave_realtime() {
  sched_param param{};
  sched_setscheduler(0, SCHED_OTHER, &param);
}

bool is_realtime() { return sched_getscheduler(0) == SCHED_FIFO; }

bool set_fifo(int priority) {
  sched_param param{};
  param.sched_priority = priority;
  return sched_setscheduler(0, SCHED_FIFO, &param) == 0;
}

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

PriorityKeeper::Change PriorityKeeper::tick(HostTime begin, HostTime end) {
  const bool too_busy = guard_.tick(begin, end);
  if (too_busy && !demoted_) {
    demoted_ = true;
    return Change::kLeave;
  }
  if (!demoted_ || guard_.time_below_limit() < kPromoteAfter) return Change::kNone;
  demoted_ = false;
  return Change::kReturn;
}

bool FifoThread::enter(int priority) {
  fifo_ = is_realtime();
  if (!fifo_) return false;
  if (priority > 0) set_fifo(priority);
  sched_param param{};
  sched_getparam(0, &param);
  priority_ = param.sched_priority;
  return true;
}

void FifoThread::tick(HostTime begin, HostTime end) {
  if (!fifo_) return;
  const PriorityKeeper::Change change = keeper_.tick(begin, end);
  if (change == PriorityKeeper::Change::kLeave) leave_realtime();
  if (change == PriorityKeeper::Change::kReturn) set_fifo(priority_);
}

}  // namespace tactus::sync
