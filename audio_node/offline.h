// A recorded run in place of bus and card: the node's loop hears the log and plays into a file, as fast as it can.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "audio_node/device/card.h"
#include "sync/log_feed.h"

namespace tactus::audio {

class FileCard;

// All times but `clock`, that of whoever looks on, are the log's.
class Offline {
 public:
  // Throws std::runtime_error with one sentence when the log holds no run.
  Offline(const std::string& log, std::string wav, double loop_rate_Hz, sync::HostTime clock);

  // The bus that the log speaks on, and its run.
  const sync::LogFeed& feed() const { return feed_; }
  // The next tick of the log.
  sync::HostTime next(sync::Bus& bus) { return feed_.next(bus); }
  // What rang at the end of the log has rung on for a second.
  bool over() const { return feed_.over(kRingOn); }
  // Opens the file; it may do so once. It outlives neither this nor the output that asked for it.
  OpenCard open();

  // Once a second a line for people.
  std::optional<std::string> progress(sync::HostTime now, sync::HostTime clock);
  // The file gets its name; before, there is none. What came of it, in lines. Throws std::runtime_error with one
  // sentence when nothing was played or the disk does not take it.
  std::string result(double rate_Hz, std::int64_t hits, std::int64_t dropped, sync::HostTime clock);

 private:
  static constexpr sync::Nanoseconds kRingOn{1'000'000'000};  // design

  sync::LogFeed feed_;
  std::string wav_;
  FileCard* card_ = nullptr;
  sync::HostTime began_, said_;
};

}  // namespace tactus::audio
