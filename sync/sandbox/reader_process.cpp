#include "sync/sandbox/reader_process.h"

#include <fcntl.h>
#include <poll.h>
#include <sched.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <stdexcept>

namespace tactus::sync {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

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

// Kills the process unless it was waited for.
class Child {
 public:
  explicit Child(pid_t id) : id_(id) {}
  ~Child() {
    if (id_ > 0) end();
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  int wait() {
    int status = -1;
    while (waitpid(id_, &status, 0) < 0 && errno == EINTR) continue;
    id_ = -1;
    return status;
  }
  int end() {
    kill(id_, SIGKILL);
    return wait();
  }

 private:
  pid_t id_;
};

pid_t start(std::vector<std::string> words, int output) {
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
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

// Moves the complete records from the front of `bytes` into `records`.
void split(std::vector<std::uint8_t>& bytes, std::vector<Record>& records) {
  std::size_t at = 0;
  while (bytes.size() - at >= 9) {
    std::uint64_t size = 0;
    std::memcpy(&size, bytes.data() + at + 1, sizeof size);
    if (size > bytes.size() - at - 9) break;
    const auto begin = bytes.begin() + static_cast<std::ptrdiff_t>(at + 9);
    records.push_back({static_cast<char>(bytes[at]), {begin, begin + static_cast<std::ptrdiff_t>(size)}});
    at += 9 + static_cast<std::size_t>(size);
  }
  bytes.erase(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(at));
}

std::string reason(int status) {
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU) return "it takes too long to read: simplify it";
  if (WIFSIGNALED(status))
    return "its reader crashed (" + std::string(strsignal(WTERMSIG(status))) + "): the file is damaged or hostile";
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) return "its reader failed: the file is damaged or hostile";
  return "";
}

}  // namespace

ReaderOutput run_reader(const std::string& program, const std::vector<std::string>& arguments,
                        const ReaderLimits& limits) {
  std::vector<std::string> words{path_of(program)};
  words.insert(words.end(), arguments.begin(), arguments.end());
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0)
    throw std::runtime_error(std::string("no pipe to a reader: ") + std::strerror(errno));
  fcntl(ends[0], F_SETPIPE_SZ, 1 << 20);  // fewer switches between the two processes; a small pipe works too
  struct Pipe {
    int descriptor;
    ~Pipe() { close(descriptor); }
  } const pipe{ends[0]};
  pid_t id = -1;
  try {
    id = start(std::move(words), ends[1]);
  } catch (...) {
    close(ends[1]);
    throw;
  }
  close(ends[1]);
  Child child(id);
  ReaderOutput output;
  std::vector<std::uint8_t> bytes, block(std::size_t{64} << 10);
  std::size_t total = 0;
  const auto deadline = Clock::now() + limits.timeout;
  while (true) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now()).count();
    pollfd readable{pipe.descriptor, POLLIN, 0};
    const int ready = left > 0 ? poll(&readable, 1, static_cast<int>(left)) : 0;
    if (ready < 0 && errno == EINTR) continue;
    const ssize_t got = ready > 0 ? read(pipe.descriptor, block.data(), block.size()) : -1;
    if (got < 0 && ready > 0 && errno == EINTR) continue;
    if (got == 0) break;
    total += got > 0 ? static_cast<std::size_t>(got) : 0;
    if (got < 0 || total > limits.max_bytes) {
      child.end();
      output.failure = got < 0 ? "it takes too long to read: simplify it"
                               : "it has more than " + std::to_string(limits.max_bytes >> 20) + " MiB of content: simplify it";
      return output;
    }
    bytes.insert(bytes.end(), block.begin(), block.begin() + got);
    split(bytes, output.records);
  }
  output.failure = reason(child.wait());
  if (output.failure.empty() && !bytes.empty()) output.failure = "its reader ended too early: the file is damaged or hostile";
  return output;
}

std::string text_of(const Record& record) {
  std::string text(record.content.begin(), record.content.begin() + static_cast<std::ptrdiff_t>(
                                               std::min<std::size_t>(record.content.size(), 400)));
  for (char& c : text)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
  return text;
}

std::vector<std::uint8_t> read_in_process(const std::string& program, const std::vector<std::string>& arguments,
                                          const ReaderLimits& limits) {
  ReaderOutput output = run_reader(program, arguments, limits);
  if (output.failure.empty() && output.records.size() != 1) output.failure = "its reader returned nothing";
  if (!output.failure.empty()) throw std::runtime_error(output.failure);
  Record& record = output.records.front();
  if (record.kind == 'R') return std::move(record.content);
  throw std::runtime_error(text_of(record));
}

}  // namespace tactus::sync
