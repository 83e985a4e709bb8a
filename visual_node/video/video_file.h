// A video for offline rendering: no picture is dropped, and write() waits for the encoder. No clock, no thread.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "sync/bus/identity.h"
#include "visual_node/settings.gen.h"
#include "visual_node/video/encoder.h"

namespace tactus::visual {

class VideoFile {
 public:
  // Writes NAME.part.mp4 until finish() renames it, so that a file of this name is complete; the destructor
  // removes the part file. Throws std::runtime_error with one sentence when the file already exists or cannot be
  // created.
  VideoFile(std::string file, int width, int height, const Settings& settings);
  ~VideoFile();
  VideoFile(const VideoFile&) = delete;
  VideoFile& operator=(const VideoFile&) = delete;

  int width() const { return width_; }
  int height() const { return height_; }
  // Appends a picture, sRGB, the lowest row first. Blocks while the encoder is busy. Throws std::runtime_error
  // with one sentence when the encoder has died.
  void write(std::span<const std::uint8_t> rgba);
  // Finishes the file and renames it. Throws std::runtime_error with one sentence on failure.
  void finish();

  std::int64_t frames() const { return frames_; }
  // A hash of the pixels of the newest picture, and of all pictures: equal numbers mean equal renderings.
  std::uint64_t newest_frame_hash() const { return newest_; }
  std::uint64_t pixel_hash() const { return pixels_; }

 private:
  std::string file_, part_;
  int width_, height_;
  std::optional<Encoder> encoder_;
  std::vector<std::uint8_t> planes_;
  std::int64_t frames_ = 0;
  std::uint64_t newest_ = sync::kFnv1aBegin, pixels_ = sync::kFnv1aBegin;
  bool finished_ = false;
};

// Name of the file that is written until the video is complete.
std::string part_file_name(const std::string& video);

}  // namespace tactus::visual
