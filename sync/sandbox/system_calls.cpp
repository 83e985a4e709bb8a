// A filter of 100 instructions that this file builds itself: libseccomp would be a further package on every machine, and
// the list is short because the process starts no thread and no program.
#include "sync/sandbox/system_calls.h"

#include <fcntl.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace tactus::sync {
namespace {

#if defined(__x86_64__)
constexpr std::uint32_t kArchitecture = AUDIT_ARCH_X86_64;
#elif defined(__aarch64__)
constexpr std::uint32_t kArchitecture = AUDIT_ARCH_AARCH64;
#elif defined(__riscv) && __riscv_xlen == 64
constexpr std::uint32_t kArchitecture = AUDIT_ARCH_RISCV64;
#else
constexpr std::uint32_t kArchitecture = 0;
#endif

// Reading, memory, time, and the end of the process, also of one that a sanitizer watches.
constexpr long kAllowed[] = {
    SYS_read, SYS_pread64, SYS_readv, SYS_write, SYS_writev, SYS_close, SYS_fstat, SYS_lseek, SYS_munmap, SYS_mremap,
    SYS_madvise, SYS_brk, SYS_futex, SYS_rt_sigaction, SYS_rt_sigprocmask, SYS_rt_sigreturn, SYS_sigaltstack,
    SYS_faccessat, SYS_readlinkat, SYS_getcwd, SYS_getdents64, SYS_clock_gettime, SYS_gettimeofday, SYS_nanosleep,
    SYS_clock_nanosleep, SYS_sched_yield, SYS_getpid, SYS_gettid, SYS_getuid, SYS_geteuid, SYS_exit, SYS_exit_group,
    SYS_getrandom, SYS_sysinfo, SYS_uname, SYS_sched_getaffinity, SYS_set_robust_list, SYS_restart_syscall,
#ifdef SYS_newfstatat
    SYS_newfstatat,
#endif
#ifdef SYS_statx
    SYS_statx,
#endif
#ifdef SYS_faccessat2
    SYS_faccessat2,
#endif
#ifdef SYS_rseq
    SYS_rseq,
#endif
#ifdef SYS_stat
    SYS_stat, SYS_lstat, SYS_access, SYS_readlink, SYS_time,
#endif
};

constexpr std::uint32_t kWriteFlags = O_WRONLY | O_RDWR | O_CREAT | O_TRUNC | O_APPEND;
constexpr std::uint32_t kDeny = SECCOMP_RET_ERRNO | EPERM;

// The low 32 bits of an argument of the call, on a little-endian machine.
constexpr std::uint32_t argument(std::size_t index) {
  return static_cast<std::uint32_t>(offsetof(seccomp_data, args) + 8 * index);
}

class Filter {
 public:
  Filter() {
    load(offsetof(seccomp_data, arch));
    add(BPF_JMP | BPF_JEQ | BPF_K, kArchitecture, 1, 0);
    ret(kDeny);
    load(offsetof(seccomp_data, nr));
  }
  void allow(long call) {
    add(BPF_JMP | BPF_JEQ | BPF_K, static_cast<std::uint32_t>(call), 0, 1);
    ret(SECCOMP_RET_ALLOW);
  }
  // Allowed unless the argument has one of these bits.
  void allow_without(long call, std::size_t index, std::uint32_t bits) {
    add(BPF_JMP | BPF_JEQ | BPF_K, static_cast<std::uint32_t>(call), 0, 4);
    load(argument(index));
    add(BPF_JMP | BPF_JSET | BPF_K, bits, 0, 1);
    ret(kDeny);
    ret(SECCOMP_RET_ALLOW);
  }
  // Allowed when the argument has this value.
  void allow_with(long call, std::size_t index, std::uint32_t value) {
    add(BPF_JMP | BPF_JEQ | BPF_K, static_cast<std::uint32_t>(call), 0, 4);
    load(argument(index));
    add(BPF_JMP | BPF_JEQ | BPF_K, value, 1, 0);
    ret(kDeny);
    ret(SECCOMP_RET_ALLOW);
  }
  bool install() {
    ret(kDeny);
    sock_fprog program{static_cast<unsigned short>(code_.size()), code_.data()};
    return prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program, 0, 0) == 0;
  }

 private:
  void add(int code, std::uint32_t value, std::uint8_t if_true, std::uint8_t if_false) {
    code_.push_back({static_cast<std::uint16_t>(code), if_true, if_false, value});
  }
  void load(std::size_t offset) { add(BPF_LD | BPF_W | BPF_ABS, static_cast<std::uint32_t>(offset), 0, 0); }
  void ret(std::uint32_t action) { add(BPF_RET | BPF_K, action, 0, 0); }

  std::vector<sock_filter> code_;
};

}  // namespace

bool restrict_system_calls() {
  if (kArchitecture == 0) return false;
  Filter filter;
  for (const long call : kAllowed) filter.allow(call);
  filter.allow_without(SYS_openat, 2, kWriteFlags);
#ifdef SYS_open
  filter.allow_without(SYS_open, 1, kWriteFlags);
#endif
  filter.allow_without(SYS_mmap, 2, PROT_EXEC);
  filter.allow_without(SYS_mprotect, 2, PROT_EXEC);
  filter.allow_with(SYS_tgkill, 0, static_cast<std::uint32_t>(getpid()));  // abort()
  return filter.install();
}

}  // namespace tactus::sync
