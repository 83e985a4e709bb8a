// Renders a recorded run (--log) instead of the bus and the sound card: into a file, as fast as possible.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "audio_node/devices/card.h"
#include "sync/node/offline.h"

namespace tactus::audio {

class FileCard;

struct OfflineOptions : sync::OfflineOptions {
  std::string wav;

  void add_to(sync::Arguments& app);
};

// All times are times of the log, except `clock`, which is this host's clock.
class Offline {
 public:
  // Throws std::runtime_error with one sentence when the log holds no run.
  Offline(const OfflineOptions& options, double loop_rate_Hz, sync::HostTime clock);

  // Like the constructor when --log is given; returns null otherwise.
  static std::unique_ptr<Offline> open(const OfflineOptions& options, double loop_rate_Hz, sync::HostTime clock);

  // Time after the end of the log in which sounding bodies decay, also with a delay of up to half of it; design.
  static constexpr sync::Nanoseconds kDecayTime{1'000'000'000};

  // The run, extended by that time and by a longer delay.
  sync::OfflineInput& run() { return run_; }
  // Opens the file; may be called once. The card must not outlive this or the output that uses it.
  OpenCard open_card();
  // Renames the file to its final name and returns a summary in lines. Throws std::runtime_error with one sentence
  // when nothing was played or the file cannot be written.
  std::string result(double rate_Hz, std::int64_t hits, std::int64_t dropped, sync::HostTime clock);

 private:
  sync::OfflineInput run_;
  std::string wav_;
  FileCard* card_ = nullptr;
};

}  // namespace tactus::audio
