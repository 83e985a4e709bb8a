#include "sync/sandbox/sandbox.h"

#include <fcntl.h>
#include <linux/capability.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "sync/sandbox/system_calls.h"

namespace tactus::sync {
namespace {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kSanitized = true;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || __has_feature(memory_sanitizer)
constexpr bool kSanitized = true;
#else
constexpr bool kSanitized = false;
#endif
#else
constexpr bool kSanitized = false;
#endif

void limit(__rlimit_resource resource, rlim_t value) {
  const rlimit both{value, value};
  setrlimit(resource, &both);
}

// Landlock (linux/landlock.h). The header of Debian 12 lacks the newer rights, so the numbers stand here.
constexpr long kCreateRuleset = 444, kAddRule = 445, kRestrictSelf = 446;  // on all architectures
constexpr std::uint64_t kReadFile = 1 << 2, kReadDir = 1 << 3;

struct RulesetAttributes {
  std::uint64_t files = 0, net = 0, scoped = 0;
};

struct [[gnu::packed]] PathBeneath {
  std::uint64_t allowed;
  std::int32_t parent;
};

void allow_reading(int ruleset, const std::filesystem::path& path) {
  const int parent = open(path.c_str(), O_PATH | O_CLOEXEC);
  struct stat status {};
  if (parent >= 0 && fstat(parent, &status) == 0) {
    const PathBeneath rule{S_ISDIR(status.st_mode) ? kReadFile | kReadDir : kReadFile, parent};
    syscall(kAddRule, ruleset, 1, &rule, 0);  // 1: LANDLOCK_RULE_PATH_BENEATH
  }
  if (parent >= 0) close(parent);
}

long landlock_version() { return syscall(kCreateRuleset, nullptr, 0, 1); }  // 1: LANDLOCK_CREATE_RULESET_VERSION

bool confine_files(const std::vector<std::filesystem::path>& readable) {
  const long version = landlock_version();
  if (version < 1) return false;
  RulesetAttributes all;
  all.files = (1 << 13) - 1;                 // every right of version 1
  if (version >= 2) all.files |= 1 << 13;    // links and renames across folders
  if (version >= 3) all.files |= 1 << 14;    // truncation
  if (version >= 5) all.files |= 1 << 15;    // ioctl on devices
  if (version >= 4) all.net = 1 | 2;         // TCP: bind and connect
  if (version >= 6) all.scoped = 1 | 2;      // abstract UNIX sockets and signals of other processes
  const std::size_t size = version >= 6 ? 24 : version >= 4 ? 16 : 8;
  const auto ruleset = static_cast<int>(syscall(kCreateRuleset, &all, size, 0));
  if (ruleset < 0) return false;
  for (const auto& path : readable) allow_reading(ruleset, path);
  const bool confined = syscall(kRestrictSelf, ruleset, 0) == 0;
  close(ruleset);
  return confined;
}

// Root without capabilities cannot read the files of other users. One capability restores that, and Landlock bounds it to
// the folders.
bool drop_capabilities(bool files_confined) {
  __user_cap_header_struct header{_LINUX_CAPABILITY_VERSION_3, 0};
  __user_cap_data_struct held[2]{}, kept[2]{};
  if (syscall(SYS_capget, &header, held) != 0) return false;
  prctl(PR_CAP_AMBIENT, PR_CAP_AMBIENT_CLEAR_ALL, 0, 0, 0);
  if (files_confined) kept[0].effective = kept[0].permitted = held[0].permitted & (1u << CAP_DAC_READ_SEARCH);
  // A service without capabilities may not even ask.
  const auto beyond = [&](int i) { return (held[i].permitted | held[i].effective | held[i].inheritable) & ~kept[i].permitted; };
  if (beyond(0) == 0 && beyond(1) == 0) return true;
  return syscall(SYS_capset, &header, kept) == 0;
}

}  // namespace

Confinement confine_process(const std::vector<std::filesystem::path>& readable, const SandboxLimits& limits) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);  // ends with the process that waits for the result
  if (!kSanitized) limit(RLIMIT_AS, limits.memory_bytes);
  limit(RLIMIT_CPU, static_cast<rlim_t>(limits.processor_s));
  limit(RLIMIT_FSIZE, 0);
  limit(RLIMIT_CORE, 0);
  if (!limits.threads) limit(RLIMIT_NPROC, 0);
  limit(RLIMIT_NOFILE, 64);
  Confinement done;
  prctl(PR_SET_DUMPABLE, 0);
  prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
  done.files = confine_files(readable);
  done.capabilities = drop_capabilities(done.files);
  done.system_calls = restrict_system_calls(limits.threads);
  return done;
}

Confinement available_confinement() {
  return {.files = landlock_version() >= 1, .system_calls = has_system_call_filter(), .capabilities = true};
}

std::string missing_measure(const Confinement& done, const Confinement& available) {
  const char* const refused = available.files && !done.files                 ? "Landlock"
                              : available.system_calls && !done.system_calls ? "a seccomp filter"
                              : available.capabilities && !done.capabilities ? "dropping capabilities"
                                                                             : nullptr;
  return refused ? "its reader cannot be confined: the kernel refuses " + std::string(refused) : "";
}

std::string confinement_notice(const Confinement& available) {
  if (available.files && available.system_calls) return "";
  const std::string lacks = available.files ? "seccomp filters" : available.system_calls ? "Landlock" : "Landlock and seccomp filters";
  const std::string risk = available.files          ? "a hostile scene, picture or sound could use the network"
                           : available.system_calls ? "a hostile scene, picture or sound could read other files of the user"
                                                    : "a hostile scene, picture or sound could read other files of the user and send them";
  return "this kernel has no " + lacks + ": " + risk +
         "; boot Linux 5.13 or later with both (lsm=landlock), or open only files from sources that you trust";
}

}  // namespace tactus::sync
