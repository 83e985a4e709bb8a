// A recorded run in place of bus and card: the node renders the log into a file, as fast as it can.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "audio_node/devices/card.h"
#include "sync/node/offline.h"

namespace tactus::audio {

class FileCard;

struct OfflineOptions : sync::OfflineOptions {
  std::string wav;

  void add_to(CLI::App& app);
};

// All times but `clock`, that of whoever looks on, are the log's.
class Offline {
 public:
  // Throws std::runtime_error with one sentence when the log holds no run.
  Offline(const OfflineOptions& options, double loop_rate_Hz, sync::HostTime clock);

  // The same where a log is asked for; else null.
  static std::unique_ptr<Offline> open(const OfflineOptions& options, double loop_rate_Hz, sync::HostTime clock);

  // What rang at the end of the log rings on for a second.
  sync::Offline& run() { return run_; }
  // Opens the file; it may do so once. It outlives neither this nor the output that asked for it.
  OpenCard open_card();
  // The file gets its name; before, there is none. What came of it, in lines. Throws std::runtime_error with one
  // sentence when nothing was played or the disk does not take it.
  std::string result(double rate_Hz, std::int64_t hits, std::int64_t dropped, sync::HostTime clock);

 private:
  static constexpr sync::Nanoseconds kRingOn{1'000'000'000};  // design

  sync::Offline run_;
  std::string wav_;
  FileCard* card_ = nullptr;
};

}  // namespace tactus::audio
