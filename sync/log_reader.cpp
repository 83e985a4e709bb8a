#include "sync/log_reader.h"

#include <fcntl.h>
#include <signal.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <stdexcept>

namespace tactus::sync {
namespace {

// LCM allows channel names of 63 characters and messages of 256 MB.
constexpr std::uint32_t kMaxChannelBytes = 63;
constexpr std::uint32_t kMaxDataBytes = 1u << 28;

std::uint64_t big_endian(const std::uint8_t* p, int bytes) {
  std::uint64_t value = 0;
  for (int i = 0; i < bytes; ++i) value = value << 8 | p[i];
  return value;
}

bool printable(std::string_view text) {
  return std::all_of(text.begin(), text.end(), [](char c) { return c > ' ' && c <= '~'; });
}

}  // namespace

bool LogScanner::sync_at(std::size_t at) const {
  return at + 4 <= bytes_.size() && big_endian(&bytes_[at], 4) == kLogSync;
}

bool LogScanner::follows_at(std::size_t at, std::int64_t number) const {
  return at + 12 <= bytes_.size() && sync_at(at) &&
         big_endian(&bytes_[at + 4], 8) == static_cast<std::uint64_t>(number) + 1;
}

bool LogScanner::event_at(std::size_t at, LogEvent& event) const {
  if (at + kLogEventHeaderBytes > bytes_.size() || !sync_at(at)) return false;
  const std::uint8_t* p = &bytes_[at];
  const std::uint64_t channel_bytes = big_endian(p + 20, 4);
  const std::uint64_t data_bytes = big_endian(p + 24, 4);
  if (channel_bytes < 1 || channel_bytes > kMaxChannelBytes || data_bytes > kMaxDataBytes ||
      at + kLogEventHeaderBytes + channel_bytes + data_bytes > bytes_.size())
    return false;
  event.number = static_cast<std::int64_t>(big_endian(p + 4, 8));
  event.timestamp_us = static_cast<std::int64_t>(big_endian(p + 12, 8));
  event.channel = {reinterpret_cast<const char*>(p) + kLogEventHeaderBytes, channel_bytes};
  event.data = bytes_.subspan(at + kLogEventHeaderBytes + channel_bytes, data_bytes);
  return printable(event.channel);
}

std::size_t LogScanner::next_event_after(std::size_t at, std::size_t until) const {
  static constexpr std::uint8_t word[4] = {0xED, 0xA1, 0xDA, 0x01};
  LogEvent ignored;
  while (at < until) {
    // No farther than needed: whoever asks often, as damage makes him, takes no longer than the log.
    const std::size_t within = std::min(bytes_.size(), until + sizeof word - 1) - at;
    const void* found = memmem(&bytes_[at], within, word, sizeof word);
    if (found == nullptr) return until;
    at = static_cast<std::size_t>(static_cast<const std::uint8_t*>(found) - bytes_.data());
    if (at < until && event_at(at, ignored)) return at;
    ++at;
  }
  return until;
}

void LogScanner::skip_to(std::size_t at) {
  ++damaged_regions_;
  damaged_bytes_ += static_cast<std::int64_t>(at - at_);
  at_ = at;
}

void LogScanner::start_at(std::size_t at) { at_ = next_event_after(std::min(at, bytes_.size()), bytes_.size()); }

bool LogScanner::next(LogEvent& event) {
  while (at_ < bytes_.size()) {
    if (!event_at(at_, event)) {
      skip_to(next_event_after(at_ + 1, bytes_.size()));
      continue;
    }
    const std::size_t end = at_ + kLogEventHeaderBytes + event.channel.size() + event.data.size();
    if (!follows_at(end, event.number)) {
      // Either the damage begins behind this event, or this event's length is a lie that swallows intact ones. A
      // lie may end at the beginning of an event, too, but not of the one that is numbered next.
      const std::size_t swallowed = next_event_after(at_ + kLogEventHeaderBytes, end);
      if (swallowed < end) {
        skip_to(swallowed);
        continue;
      }
    }
    at_ = end;
    ++events_;
    return true;
  }
  return false;
}

namespace {

// The newest mapping, for say_cut.
std::atomic<const std::uint8_t*> mapped_begin{nullptr}, mapped_end{nullptr};

// What is touched behind the end of a file that was cut after it had been mapped is SIGBUS, which kills without a
// word.
void say_cut(int, siginfo_t* info, void*) {
  const auto* at = static_cast<const std::uint8_t*>(info->si_addr);
  if (at < mapped_begin.load() || at >= mapped_end.load()) {
    signal(SIGBUS, SIG_DFL);  // not ours: it comes again, and does what it does
    return;
  }
  static constexpr char text[] = "the log was cut while it was read; give a copy that nobody writes to\n";
  const ssize_t said = write(STDERR_FILENO, text, sizeof text - 1);
  _exit(said < 0 ? 2 : 1);
}

void tell_of_cuts(std::span<const std::uint8_t> bytes) {
  mapped_begin = bytes.data();
  mapped_end = bytes.data() + bytes.size();
  struct sigaction action {};
  action.sa_sigaction = say_cut;
  action.sa_flags = SA_SIGINFO;
  sigaction(SIGBUS, &action, nullptr);
}

}  // namespace

MappedFile::MappedFile(const std::string& path) {
  const auto refuse = [&](int fd) {
    const std::string why = strerror(errno);
    if (fd >= 0) close(fd);
    throw std::runtime_error("cannot read " + path + " (" + why + "); give the path of a log");
  };
  const int fd = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  struct stat status {};
  if (fd < 0 || fstat(fd, &status) != 0) refuse(fd);
  if (S_ISDIR(status.st_mode)) errno = EISDIR, refuse(fd);
  if (status.st_size > 0) {
    const auto size = static_cast<std::size_t>(status.st_size);
    void* start = mmap(nullptr, size, PROT_READ, MAP_PRIVATE, fd, 0);
    if (start == MAP_FAILED) refuse(fd);
    madvise(start, size, MADV_SEQUENTIAL);
    bytes_ = {static_cast<const std::uint8_t*>(start), size};
    tell_of_cuts(bytes_);
  }
  close(fd);
}

MappedFile::~MappedFile() {
  if (!bytes_.empty()) munmap(const_cast<std::uint8_t*>(bytes_.data()), bytes_.size());
}

}  // namespace tactus::sync
