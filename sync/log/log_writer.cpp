#include "sync/log/log_writer.h"

#include <fcntl.h>
#include <string.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <stdexcept>

#include "sync/log/log_reader.h"

namespace tactus::sync {
namespace {

constexpr std::size_t kBlockBytes = 1 << 16;

void append_big_endian(std::vector<std::uint8_t>& out, std::uint64_t value, int bytes) {
  for (int shift = 8 * (bytes - 1); shift >= 0; shift -= 8)
    out.push_back(static_cast<std::uint8_t>(value >> shift));
}

}  // namespace

FileSink::FileSink(const std::string& path)
    : fd_(open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644)) {
  if (fd_ < 0)
    throw std::runtime_error("cannot create " + path + " (" + strerror(errno) + "); choose a folder that exists and is writable");
}

FileSink::~FileSink() { close(fd_); }

std::string FileSink::append(std::span<const std::uint8_t> bytes) {
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t n = ::write(fd_, bytes.data() + done, bytes.size() - done);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) {
      const std::string reason = n < 0 ? strerror(errno) : "nothing was written";
      // Removes the incomplete event, so that the file stays readable, also for tools that stop at the first damage.
      if (ftruncate(fd_, size_) != 0 || lseek(fd_, size_, SEEK_SET) < 0) size_ += static_cast<std::int64_t>(done);
      return reason;
    }
    done += static_cast<std::size_t>(n);
  }
  size_ += static_cast<std::int64_t>(done);
  return "";
}

void append_event(std::vector<std::uint8_t>& out, std::int64_t number, std::int64_t timestamp_us, std::string_view channel,
                  std::span<const std::uint8_t> data) {
  append_big_endian(out, kLogSync, 4);
  append_big_endian(out, static_cast<std::uint64_t>(number), 8);
  append_big_endian(out, static_cast<std::uint64_t>(timestamp_us), 8);
  append_big_endian(out, channel.size(), 4);
  append_big_endian(out, data.size(), 4);
  out.insert(out.end(), channel.begin(), channel.end());
  out.insert(out.end(), data.begin(), data.end());
}

LogWriter::LogWriter(std::unique_ptr<LogSink> sink, std::size_t max_waiting_bytes)
    : sink_(std::move(sink)), max_waiting_bytes_(max_waiting_bytes) {}

void LogWriter::write(std::int64_t timestamp_us, std::string_view channel, std::span<const std::uint8_t> data) {
  const std::size_t size = kLogEventHeaderBytes + channel.size() + data.size();
  if (waiting_bytes_ + size > max_waiting_bytes_) {
    ++lost_;
    return;
  }
  waiting_bytes_ += size;
  bytes_ += static_cast<std::int64_t>(size);
  last_us_ = std::max(last_us_, timestamp_us);
  if (blocks_.empty() || blocks_.back().size() + size > kBlockBytes) blocks_.emplace_back();
  std::vector<std::uint8_t>& block = blocks_.back();
  append_event(block, events_++, last_us_, channel, data);
}

void LogWriter::flush() {
  error_.clear();
  while (!blocks_.empty()) {
    error_ = sink_->append(blocks_.front());
    if (!error_.empty()) return;
    waiting_bytes_ -= blocks_.front().size();
    blocks_.pop_front();
  }
}

}  // namespace tactus::sync
