// A recorded run in place of bus and screen: the node draws the log into a file, as fast as it can. A frame takes no time there, so that nothing in it depends on how fast the machine draws: the same log
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
  std::string frames;    // table of when each frame is and what it shows, CSV; empty: none
  std::string snapshot;  // PNG file; empty: none
  double snapshot_every_s = 1;

  void add_to(CLI::App& app);
};

// All times but `clock`, that of whoever looks on, are the log's.
class Offline {
 public:
  // Throws std::runtime_error with one sentence when the log holds no run, or the video would lie where something
  // is.
  Offline(const OfflineOptions& options, double rate_Hz, sync::HostTime clock);

  // The same where a log is asked for; else null.
  static std::unique_ptr<Offline> open(const OfflineOptions& options, double rate_Hz, sync::HostTime clock);

  sync::OfflineInput& run() { return run_; }
  sync::HostTime now() const { return run_.now(); }
  // A scene has come. Throws std::runtime_error with one sentence when its pictures do not fit the video.
  void begin(int width, int height, const Settings& settings);
  // The picture of this tick; read() fills the bytes given, sRGB, the lowest row first. Before the first scene
  // there is none.
  void add(const std::function<void(std::span<std::uint8_t>)>& read);
  // The file gets its name. What came of it, in lines. Throws std::runtime_error with one sentence when there is
  // none.
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
