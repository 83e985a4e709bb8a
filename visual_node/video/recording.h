// Records pictures: a video file and snapshots, each written by its own thread.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <tactus/media_clock_t.hpp>
#include <thread>

#include "sync/time/time.h"
#include "visual_node/settings.gen.h"
#include "visual_node/video/frame_sink.h"
#include "visual_node/video/slots.h"

namespace tactus::visual {

struct RecordingOptions {
  std::string folder = ".";
  bool video = true;
  std::string snapshot;         // PNG file; empty: none
  double snapshot_every_s = 1;  // interval of the snapshots, which overwrite each other
  std::string name = "video";   // base name of the video file
};

// Returns the path of a new video: for the name "video", "video.mp4" in the folder, or "video.2.mp4" and so on
// when that file exists.
std::string next_video_path(const std::string& folder, const std::string& name = "video");

class Recording {
 public:
  explicit Recording(RecordingOptions options);
  ~Recording();

  // Begins a new video file for pictures of this size; the previous one is finished in the background.
  void begin(int width, int height, const Settings& settings);
  // Call when the picture of this tick was presented, at `fence`. read() fills its argument, sRGB, the lowest row
  // first; it is called only when a picture is needed. Returns the pair to publish, if one is due; its header is
  // not stamped.
  std::optional<media_clock_t> add(std::int64_t tick, sync::HostTime fence,
                                   const std::function<void(std::span<std::uint8_t>)>& read);
  // Why a requested video is missing; empty: it is being written.
  std::string error() const;
  // Pictures dropped because the encoder was busy; their slots repeat the previous picture.
  std::int64_t dropped() const { return dropped_; }
  // One line for the note of NODE_HEALTH: the two above.
  std::string status_text() const;

 private:
  struct Shared;  // shared with the writing thread

  RecordingOptions options_;
  std::shared_ptr<Shared> shared_;
  std::unique_ptr<FrameSink> video_, snapshots_;
  std::jthread ending_;
  std::string file_;
  std::optional<SlotClock> clock_;
  sync::HostTime next_snapshot_{};
  std::int64_t dropped_ = 0;
};

}  // namespace tactus::visual
