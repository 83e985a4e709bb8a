#include "sync/log/mapped_log.h"

#include <signal.h>
#include <sys/mman.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <limits>
#include <stdexcept>
#include <vector>

#include "sync/log/log_contract.h"
#include "sync/log/log_parts.h"
#include "sync/log/log_reader.h"
#include "sync/sandbox/regular_file.h"

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

[[noreturn]] void refuse(const std::string& path, const std::string& why) {
  throw std::runtime_error("cannot read " + path + " (" + why + "); give the path of a log");
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

MappedLog::MappedLog(const std::string& path, LogTypes types) : MappedLog(std::vector<std::string>{path}, types) {}

MappedLog::MappedLog(const std::vector<std::string>& paths, LogTypes types) {
  std::vector<std::string> names;
  for (const std::string& path : paths)
    for (std::string& name : files_of(path)) names.push_back(std::move(name));
  std::vector<File> files(names.size());
  std::size_t size = 0;
  for (std::size_t i = 0; i < names.size(); ++i) {
    try {
      RegularFile file(names[i], std::numeric_limits<std::uintmax_t>::max());
      files[i].bytes = file.size_bytes();
      files[i].descriptor = file.release();
    } catch (const std::runtime_error& e) {
      refuse(names[i], e.what());
    }
    if (files[i].bytes > 0) size = with_border(size) + files[i].bytes;
  }
  if (size == 0) return;
  // Reserves the whole length first, so that each part has room behind the previous one.
  void* start = mmap(nullptr, size, PROT_READ, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (start == MAP_FAILED) refuse(names.front(), std::strerror(errno));
  bytes_ = {static_cast<const std::uint8_t*>(start), size};
  std::size_t at = 0;
  for (std::size_t i = 0; i < names.size(); ++i) {
    at = with_border(at);
    if (files[i].bytes == 0) continue;
    void* place = static_cast<std::uint8_t*>(start) + at;
    if (mmap(place, files[i].bytes, PROT_READ, MAP_PRIVATE | MAP_FIXED, files[i].descriptor, 0) == MAP_FAILED) {
      const std::string why = std::strerror(errno);
      munmap(start, size);
      refuse(names[i], why);
    }
    at += files[i].bytes;
  }
  madvise(start, size, MADV_SEQUENTIAL);
  tell_of_cuts(bytes_);
  if (types == LogTypes::kCurrent) require_current_types(bytes_, paths.front());
}

MappedLog::~MappedLog() {
  if (!bytes_.empty()) munmap(const_cast<std::uint8_t*>(bytes_.data()), bytes_.size());
}

}  // namespace tactus::sync
