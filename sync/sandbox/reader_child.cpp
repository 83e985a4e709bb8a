#include "sync/sandbox/reader_child.h"

#include <fcntl.h>
#include <poll.h>
#include <sched.h>
#include <signal.h>
#include <spawn.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <utility>

namespace tactus::sync {
namespace {

namespace fs = std::filesystem;

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kShowMessages = true;  // the report of a sanitizer
#else
constexpr bool kShowMessages = false;
#endif

std::string path_of(const std::string& program) {
  std::error_code error;
  fs::path path = fs::read_symlink("/proc/self/exe", error).parent_path() / program;
  if (const char* folder = std::getenv("TACTUS_BIN"); !fs::exists(path, error) && folder) path = fs::path(folder) / program;
  if (!fs::exists(path, error))
    throw std::runtime_error("the program " + path.string() + ", which reads such files, is missing; build or install it");
  return path.string();
}

// Only what the loader of shared libraries and the sanitizers need.
std::vector<std::string> environment() {
  std::vector<std::string> all{"LC_ALL=C"};
  for (const char* name : {"LD_LIBRARY_PATH", "ASAN_OPTIONS", "UBSAN_OPTIONS", "TSAN_OPTIONS", "LSAN_OPTIONS"})
    if (const char* value = std::getenv(name)) all.push_back(std::string(name) + "=" + value);
  return all;
}

std::vector<char*> pointers(std::vector<std::string>& words) {
  std::vector<char*> all;
  for (std::string& word : words) all.push_back(word.data());
  all.push_back(nullptr);
  return all;
}

pid_t start(std::vector<std::string> words, int input, int output) {
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  if (input < 0)
    posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  else
    posix_spawn_file_actions_adddup2(&files, input, STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&files, output, STDOUT_FILENO);
  if (!kShowMessages) posix_spawn_file_actions_addopen(&files, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_addclosefrom_np(&files, 3);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSIGMASK |
                                            POSIX_SPAWN_SETSCHEDULER);
  sigset_t all, none;
  sigfillset(&all);
  sigemptyset(&none);
  posix_spawnattr_setsigdefault(&attributes, &all);
  posix_spawnattr_setsigmask(&attributes, &none);
  const sched_param normal{};
  posix_spawnattr_setschedpolicy(&attributes, SCHED_OTHER);
  posix_spawnattr_setschedparam(&attributes, &normal);
  std::vector<std::string> variables = environment();
  pid_t child = -1;
  const int error = posix_spawn(&child, words.front().c_str(), &files, &attributes, pointers(words).data(),
                                pointers(variables).data());
  posix_spawn_file_actions_destroy(&files);
  posix_spawnattr_destroy(&attributes);
  if (error != 0)
    throw std::runtime_error("the program " + words.front() + " cannot be started (" + std::strerror(error) + ")");
  return child;
}

std::string reason(int status) {
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU) return "it takes too long to read: simplify it";
  if (WIFSIGNALED(status))
    return "its reader crashed (" + std::string(strsignal(WTERMSIG(status))) + "): the file is damaged or hostile; export it again";
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) return "its reader failed: the file is damaged or hostile; export it again";
  return "";
}

}  // namespace

ReaderChild::ReaderChild(const std::string& program, const std::vector<std::string>& arguments, int input, int output) {
  std::vector<std::string> words{path_of(program)};
  words.insert(words.end(), arguments.begin(), arguments.end());
  id_ = start(std::move(words), input, output);
}

ReaderChild::~ReaderChild() { end(); }

std::string ReaderChild::wait(std::chrono::milliseconds longest) {
  const auto handle = static_cast<int>(syscall(SYS_pidfd_open, id_, 0));  // readable when the process has ended
  pollfd ended{handle, POLLIN, 0};
  int ready = handle < 0 ? 1 : -1;  // before Linux 5.3: waits without a limit
  const auto deadline = std::chrono::steady_clock::now() + longest;
  while (ready < 0) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline - std::chrono::steady_clock::now());
    ready = poll(&ended, 1, static_cast<int>(std::max(left.count(), std::chrono::milliseconds::rep{0})));
    if (ready < 0 && errno != EINTR) ready = 0;
  }
  if (handle >= 0) close(handle);
  if (ready == 0) kill(id_, SIGKILL);
  int status = -1;
  while (waitpid(id_, &status, 0) < 0 && errno == EINTR) continue;
  id_ = -1;
  return reason(status);
}

void ReaderChild::end() {
  if (id_ <= 0) return;
  kill(id_, SIGKILL);
  wait(std::chrono::milliseconds(1000));
}

}  // namespace tactus::sync
