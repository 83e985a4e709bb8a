#include "sync/sandbox/system_calls.h"

#include <fcntl.h>
#include <sched.h>
#include <seccomp.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <memory>

namespace tactus::sync {
namespace {

// Reading, memory, time, and the end of the process, also of one that a sanitizer watches. libseccomp leaves out those that
// the architecture does not have.
constexpr int kAllowed[] = {
    SCMP_SYS(read), SCMP_SYS(pread64), SCMP_SYS(readv), SCMP_SYS(write), SCMP_SYS(writev), SCMP_SYS(close), SCMP_SYS(fstat),
    SCMP_SYS(lseek), SCMP_SYS(munmap), SCMP_SYS(mremap), SCMP_SYS(madvise), SCMP_SYS(brk), SCMP_SYS(futex),
    SCMP_SYS(rt_sigaction), SCMP_SYS(rt_sigprocmask), SCMP_SYS(rt_sigreturn), SCMP_SYS(sigaltstack), SCMP_SYS(faccessat),
    SCMP_SYS(faccessat2), SCMP_SYS(access), SCMP_SYS(readlink), SCMP_SYS(readlinkat), SCMP_SYS(stat), SCMP_SYS(lstat),
    SCMP_SYS(newfstatat), SCMP_SYS(statx), SCMP_SYS(getcwd), SCMP_SYS(getdents64), SCMP_SYS(time), SCMP_SYS(clock_gettime),
    SCMP_SYS(gettimeofday), SCMP_SYS(nanosleep), SCMP_SYS(clock_nanosleep), SCMP_SYS(sched_yield), SCMP_SYS(getpid),
    SCMP_SYS(gettid), SCMP_SYS(getuid), SCMP_SYS(geteuid), SCMP_SYS(exit), SCMP_SYS(exit_group), SCMP_SYS(getrandom),
    SCMP_SYS(sysinfo), SCMP_SYS(uname), SCMP_SYS(sched_getaffinity), SCMP_SYS(set_robust_list), SCMP_SYS(rseq),
#ifdef __SANITIZE_ADDRESS__
    SCMP_SYS(pipe), SCMP_SYS(pipe2),  // UBSan writes memory to a pipe of its own to learn whether it can be read
#endif
    SCMP_SYS(restart_syscall)};

constexpr std::uint64_t kWriteFlags = O_WRONLY | O_RDWR | O_CREAT | O_TRUNC | O_APPEND;

struct Release {
  void operator()(void* filter) const { seccomp_release(filter); }
};

}  // namespace

bool restrict_system_calls(bool threads) {
  const std::unique_ptr<void, Release> filter(seccomp_init(SCMP_ACT_ERRNO(EPERM)));
  if (!filter) return false;
  bool complete = true;
  for (const int call : kAllowed) complete &= seccomp_rule_add(filter.get(), SCMP_ACT_ALLOW, call, 0) == 0;
  // Allowed when the bits of `mask` in an argument have this value.
  const auto allow_with = [&](int call, unsigned argument, std::uint64_t mask, std::uint64_t value) {
    const scmp_arg_cmp rule{argument, SCMP_CMP_MASKED_EQ, mask, value};
    complete &= seccomp_rule_add_array(filter.get(), SCMP_ACT_ALLOW, call, 1, &rule) == 0;
  };
  allow_with(SCMP_SYS(openat), 2, kWriteFlags, 0);
  allow_with(SCMP_SYS(open), 1, kWriteFlags, 0);
  allow_with(SCMP_SYS(mmap), 2, PROT_EXEC, 0);
  allow_with(SCMP_SYS(mprotect), 2, PROT_EXEC, 0);
  allow_with(SCMP_SYS(tgkill), 0, UINT64_MAX, static_cast<std::uint64_t>(getpid()));  // abort()
  if (threads) {
    allow_with(SCMP_SYS(clone), 0, CLONE_THREAD, CLONE_THREAD);  // a thread, and no process
    // The filter cannot read the arguments of clone3; libc uses clone where the kernel lacks it.
    complete &= seccomp_rule_add(filter.get(), SCMP_ACT_ERRNO(ENOSYS), SCMP_SYS(clone3), 0) == 0;
  }
  return complete && seccomp_load(filter.get()) == 0;
}

bool has_system_call_filter() {
  // A filter of no program is refused with EFAULT by a kernel that has filters, otherwise with EINVAL.
  return prctl(PR_SET_SECCOMP, 2 /* SECCOMP_MODE_FILTER */, nullptr, 0, 0) != 0 && errno == EFAULT;
}

}  // namespace tactus::sync
