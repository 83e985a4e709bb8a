// Writes an LCM event log that the stock tools read. Data that the disk refuses is stored up to a bound, then dropped and
// counted; the file always ends at the end of an event.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tactus::sync {

// The destination of the bytes.
class LogSink {
 public:
  virtual ~LogSink() = default;
  // Writes all of the bytes or none. Returns an empty string when done, else the reason.
  virtual std::string append(std::span<const std::uint8_t> bytes) = 0;
};

// A file that did not exist before.
class FileSink : public LogSink {
 public:
  // Throws std::runtime_error with one sentence.
  explicit FileSink(const std::string& path);
  ~FileSink() override;
  std::string append(std::span<const std::uint8_t> bytes) override;

 private:
  int fd_ = -1;
  std::int64_t size_ = 0;
};

// Appends one event in the format of sync/log/log_reader.h.
void append_event(std::vector<std::uint8_t>& out, std::int64_t number, std::int64_t timestamp_us, std::string_view channel,
                  std::span<const std::uint8_t> data);

class LogWriter {
 public:
  // Limit of the data that waits for a full or slow disk.
  static constexpr std::size_t kMaxWaitingBytes = 64 << 20;

  explicit LogWriter(std::unique_ptr<LogSink> sink, std::size_t max_waiting_bytes = kMaxWaitingBytes);

  // Stamps never decrease: a smaller one is raised to the previous one.
  void write(std::int64_t timestamp_us, std::string_view channel, std::span<const std::uint8_t> data);
  // Passes all waiting data to the sink.
  void flush();

  std::int64_t events() const { return events_; }
  // Bytes of all events, written or waiting.
  std::int64_t bytes() const { return bytes_; }
  // Number of dropped events.
  std::int64_t lost() const { return lost_; }
  // Reason of the last flush's failure; empty: it succeeded.
  const std::string& error() const { return error_; }

 private:
  std::unique_ptr<LogSink> sink_;
  std::size_t max_waiting_bytes_;
  // In blocks of whole events, so that a nearly full disk receives as much as fits.
  std::deque<std::vector<std::uint8_t>> blocks_;
  std::size_t waiting_bytes_ = 0;
  std::int64_t last_us_ = INT64_MIN;
  std::int64_t events_ = 0;
  std::int64_t bytes_ = 0;
  std::int64_t lost_ = 0;
  std::string error_;
};

}  // namespace tactus::sync
