#include "sync/log/mapped_log.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <vector>

#include "sync/log/log_contract.h"
#include "sync/log/log_parts.h"
#include "sync/log/log_reader.h"

namespace tactus::sync {
namespace {

// The newest mapping, for say_cut.
std::atomic<const std::uint8_t*> mapped_begin{nullptr}, mapped_end{nullptr};

// Handles SIGBUS. An access beyond the end of a truncated file raises it, and by default it ends the process without a
// message.
void say_cut(int, siginfo_t* info, void*) {
  const auto* at = static_cast<const std::uint8_t*>(info->si_addr);
  if (at < mapped_begin.load() || at >= mapped_end.load()) {
    signal(SIGBUS, SIG_DFL);  // another cause: the signal is raised again with its default action
    return;
  }
  static constexpr char text[] = "another process truncated the log while it was read; give a copy that no process writes to\n";
  const ssize_t written = write(STDERR_FILENO, text, sizeof text - 1);
  _exit(written < 0 ? 2 : 1);
}

void tell_of_cuts(std::span<const std::uint8_t> bytes) {
  mapped_begin = bytes.data();
  mapped_end = bytes.data() + bytes.size();
  struct sigaction action {};
  action.sa_sigaction = say_cut;
  action.sa_flags = SA_SIGINFO;
  sigaction(SIGBUS, &action, nullptr);
}

struct File {
  int descriptor = -1;
  std::size_t bytes = 0;
  ~File() {
    if (descriptor >= 0) close(descriptor);
  }
};

[[noreturn]] void refuse(const std::string& path) {
  throw std::runtime_error("cannot read " + path + " (" + std::strerror(errno) + "); give the path of a log");
}

std::vector<std::string> files_of(const std::string& path) {
  std::error_code ignored;
  if (!std::filesystem::is_directory(path, ignored)) return {path};
  const std::vector<std::string> parts = log_parts_in(path);
  if (parts.empty())
    throw std::runtime_error("the folder " + path + " holds no run.lcmlog; give the folder of a run, or a log");
  return parts;
}

std::size_t with_border(std::size_t bytes) { return (bytes + kLogPartBytes - 1) / kLogPartBytes * kLogPartBytes; }

}  // namespace

MappedLog::MappedLog(const std::string& path, LogTypes types) {
  const std::vector<std::string> names = files_of(path);
  std::vector<File> files(names.size());
  std::size_t size = 0;
  for (std::size_t i = 0; i < names.size(); ++i) {
    struct stat status {};
    files[i].descriptor = open(names[i].c_str(), O_RDONLY | O_CLOEXEC);
    if (files[i].descriptor < 0 || fstat(files[i].descriptor, &status) != 0) refuse(names[i]);
    files[i].bytes = static_cast<std::size_t>(status.st_size);
    if (files[i].bytes > 0) size = with_border(size) + files[i].bytes;
  }
  if (size == 0) return;
  // Reserves the whole length first, so that each part has room behind the previous one.
  void* start = mmap(nullptr, size, PROT_READ, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (start == MAP_FAILED) refuse(path);
  bytes_ = {static_cast<const std::uint8_t*>(start), size};
  std::size_t at = 0;
  for (std::size_t i = 0; i < names.size(); ++i) {
    at = with_border(at);
    if (files[i].bytes == 0) continue;
    void* place = static_cast<std::uint8_t*>(start) + at;
    if (mmap(place, files[i].bytes, PROT_READ, MAP_PRIVATE | MAP_FIXED, files[i].descriptor, 0) == MAP_FAILED) {
      munmap(start, size);
      refuse(names[i]);
    }
    at += files[i].bytes;
  }
  madvise(start, size, MADV_SEQUENTIAL);
  tell_of_cuts(bytes_);
  if (types == LogTypes::kCurrent) require_current_types(bytes_, path);
}

MappedLog::~MappedLog() {
  if (!bytes_.empty()) munmap(const_cast<std::uint8_t*>(bytes_.data()), bytes_.size());
}

}  // namespace tactus::sync
