// Reads an LCM event log and resumes after damage. Pure.
//
// Format (LCM, docs/content/log-file-format.md), big-endian: u32 sync word, i64 number, i64 time stamp in us, i32 length of
// the channel, i32 length of the data, channel, data. There is no checksum, so damage inside an event's data is only found by
// decoding it.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace tactus::sync {

inline constexpr std::uint32_t kLogSync = 0xEDA1DA01;
inline constexpr std::size_t kLogEventHeaderBytes = 28;
// When several files are read as one log (sync/log/mapped_log.h), each begins at a multiple of this. Design: the largest
// Linux memory page on supported machines, so that a file can be mapped there.
inline constexpr std::size_t kLogPartBytes = 65536;

// True for a name that LCM can send: 1 to 63 bytes of any kind but 0.
bool is_legal_channel(std::string_view name);

// One event; the views are valid as long as the bytes that it was read from.
struct LogEvent {
  std::int64_t number = 0;
  std::int64_t timestamp_us = 0;
  std::string_view channel;
  std::span<const std::uint8_t> data;

  // The byte of the log that it was read from.
  std::size_t begins_at(std::span<const std::uint8_t> log) const {
    return static_cast<std::size_t>(reinterpret_cast<const std::uint8_t*>(channel.data()) - log.data()) - kLogEventHeaderBytes;
  }
};

// Finds every intact event; skips damaged bytes up to the next one.
class LogScanner {
 public:
  explicit LogScanner(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  // False at the end.
  bool next(LogEvent& event);
  // Continues with the first event that begins at or after this byte; skipped bytes do not count as damage.
  void seek(std::size_t at);
  // The position of the next event, or the end.
  std::size_t at() const { return at_; }

  std::int64_t events() const { return events_; }
  // Number of skipped byte ranges, and of skipped bytes. A truncated last event is one of them.
  std::int64_t damaged_regions() const { return damaged_regions_; }
  std::int64_t damaged_bytes() const { return damaged_bytes_; }

 private:
  bool sync_at(std::size_t at) const;
  // True when the event with the number after `number` begins there.
  bool follows_at(std::size_t at, std::int64_t number) const;
  // Parses an event at `at` when its header is plausible and it lies within the bytes.
  bool event_at(std::size_t at, LogEvent& event) const;
  std::size_t next_event_after(std::size_t at, std::size_t until) const;
  void skip_to(std::size_t at);
  // Skips the zeros between two parts of a recording.
  void skip_padding();

  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
  std::int64_t events_ = 0;
  std::int64_t damaged_regions_ = 0;
  std::int64_t damaged_bytes_ = 0;
};

}  // namespace tactus::sync
