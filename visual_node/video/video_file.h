// A video of pictures that come as fast as they are drawn: none is dropped, whoever is slower waits. No clock, no
// thread.
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
  // Until finish() the file is NAME.part.mp4, which goes with this, so that what bears the name is whole. Throws
  // std::runtime_error with one sentence when there is such a file already, or it cannot be made.
  VideoFile(std::string file, int width, int height, const Settings& settings);
  ~VideoFile();
  VideoFile(const VideoFile&) = delete;
  VideoFile& operator=(const VideoFile&) = delete;

  int width() const { return width_; }
  int height() const { return height_; }
  // A picture, sRGB, the lowest row first. Blocks while the encoder is busy. Throws std::runtime_error with one
  // sentence when it has died.
  void write(std::span<const std::uint8_t> rgba);
  // The file is whole and gets its name. Throws std::runtime_error with one sentence when it is not.
  void finish();

  std::int64_t frames() const { return frames_; }
  // A hash of all pixels of the newest picture, and of those of all pictures: two renderings with one number show
  // the same.
  std::uint64_t pixels_of_newest() const { return newest_; }
  std::uint64_t pixels() const { return pixels_; }

 private:
  std::string file_, part_;
  int width_, height_;
  std::optional<Encoder> encoder_;
  std::vector<std::uint8_t> planes_;
  std::int64_t frames_ = 0;
  std::uint64_t newest_ = sync::kFnv1aBegin, pixels_ = sync::kFnv1aBegin;
  bool finished_ = false;
};

// Name of the file that is written to until the video is whole.
std::string part_of(const std::string& video);

}  // namespace tactus::visual
