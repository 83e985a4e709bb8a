// Plays a log for pages: forward at any speed, from any position. Pure, except that it maps the file. The log is scanned once
// in pieces while it plays, so that a large one opens immediately.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sync/log/mapped_log.h"
#include "sync/log/timestamped_events.h"
#include "sync/time/time.h"

namespace tactus::live {

class LogPlayer {
 public:
  using EventHandler = std::function<void(std::string_view channel, std::span<const std::uint8_t> bytes, sync::HostTime arrival)>;
  // Design: at most a tenth of a second of reading or playing in one call, on a slow machine.
  static constexpr int kMaxEvents = 20'000;
  // Length of the log before the position of a seek that is shown, too, so that graphs are not empty.
  static constexpr sync::Nanoseconds kSeekLead{3'000'000'000};

  // run: its number among the runs of the log, from 1. Throws std::runtime_error with one sentence when the file is not a log
  // or has no such run.
  explicit LogPlayer(const std::string& path, int run = 1);
  // The same for bytes that outlive this object.
  explicit LogPlayer(std::span<const std::uint8_t> bytes, int run = 1);

  // Scans the next piece; returns true while there is more.
  bool scan_next();
  void play(bool on, double rate) { playing_ = on, rate_ = rate; }
  // The next advance starts kSeekLead earlier, and immediately passes on the events in between.
  void seek(double to_s);
  // Advances by this real time: passes on the events recorded in that interval.
  void advance(sync::Nanoseconds dt, const EventHandler& on_event);

  bool playing() const { return playing_; }
  double rate() const { return rate_; }
  // The position on the recorder's clock.
  sync::HostTime position() const { return position_; }
  double position_s() const { return sync::to_seconds(position_ - begin_); }
  double length_s() const { return sync::to_seconds(end() - begin_); }
  std::int64_t damaged_regions() const { return index_.damaged_regions(); }
  // Sentences about other runs in the log, jumps of the recorder's clock and copies of messages, as far as the log was scanned.
  std::vector<std::string> warnings() const { return index_.warnings(run_); }

 private:
  void begin();
  sync::HostTime end() const;

  std::unique_ptr<sync::MappedLog> file_;
  sync::LogIndex index_;
  int run_;
  std::optional<sync::TimestampedEvents> events_;
  sync::HostTime begin_{}, position_{};
  sync::LogEvent pending_;
  sync::HostTime pending_at_{};
  bool has_pending_ = false, playing_ = true;
  double rate_ = 1;
};

}  // namespace tactus::live
