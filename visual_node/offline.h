// Offline rendering: a recorded run replaces bus and screen, and the node renders the log to a file as fast as it
// can. Drawing takes no simulated time, so the result does not depend on the speed of the machine: the same log
// gives the same pixels.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "sync/node/offline.h"
#include "visual_node/video/video_file.h"

namespace tactus::visual {

struct OfflineOptions : sync::OfflineOptions {
  std::string video;
  std::string frames;    // table of the time and the pixel hash of each frame, CSV; empty: none
  std::string snapshot;  // PNG file; empty: none
  double snapshot_every_s = 1;

  void add_to(sync::Arguments& app);
};

// All times are on the clock of the log, except `clock`, the current time of this host.
class Offline {
 public:
  // Throws std::runtime_error with one sentence when the log holds no run, or a file of the video's name exists.
  Offline(const OfflineOptions& options, double rate_Hz, sync::HostTime clock);

  // Creates the object if the options name a log; else null.
  static std::unique_ptr<Offline> open(const OfflineOptions& options, double rate_Hz, sync::HostTime clock);

  sync::OfflineInput& run() { return run_; }
  sync::HostTime now() const { return run_.now(); }
  // Call when a scene is loaded. Throws std::runtime_error with one sentence when its pictures do not fit the
  // video.
  void begin(int width, int height, const Settings& settings);
  // Adds the picture of this tick; read() fills its argument, sRGB, the lowest row first. Does nothing before the
  // first scene.
  void add(const std::function<void(std::span<std::uint8_t>)>& read);
  // Finishes and renames the video. Returns a summary. Throws std::runtime_error with one sentence when the log
  // has no scene.
  std::string result(std::int64_t flashed, std::int64_t dropped, sync::HostTime clock);

 private:
  OfflineOptions options_;
  double rate_Hz_;
  sync::OfflineInput run_;
  std::unique_ptr<VideoFile> video_;
  std::unique_ptr<sync::AtomicFile> frames_;
  std::vector<std::uint8_t> rgba_;
  sync::HostTime next_snapshot_{};
};

}  // namespace tactus::visual
