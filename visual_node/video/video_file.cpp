#include "visual_node/video/video_file.h"

#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <utility>

#include "visual_node/video/i420.h"

namespace tactus::visual {
namespace {

// FNV-1a of words of 64 bits, the first byte lowest: eight times as fast as the bytewise version, which takes a
// tenth of the time of a frame.
std::uint64_t hash_of(std::span<const std::uint8_t> bytes) {
  std::uint64_t h = sync::kFnv1aBegin;
  for (; bytes.size() >= 8; bytes = bytes.subspan(8)) {
    std::uint64_t word;
    std::memcpy(&word, bytes.data(), sizeof word);
    h = (h ^ word) * 1099511628211u;
    h ^= h >> 32;  // otherwise the upper bits of a word never affect the lower bits
  }
  return sync::fnv1a_64(h, bytes.data(), bytes.size());
}

}  // namespace

std::string part_file_name(const std::string& video) { return video + ".part.mp4"; }

VideoFile::VideoFile(std::string file, int width, int height, const Settings& settings)
    : file_(std::move(file)),
      part_(part_file_name(file_)),
      width_(width),
      height_(height),
      planes_(i420_bytes(width, height)) {
  std::error_code none;
  for (const std::string& there : {file_, part_})
    if (std::filesystem::exists(there, none))
      throw std::runtime_error(there + " exists and is not overwritten; remove it or choose another --video");
  if (!std::ofstream(part_, std::ios::binary))
    throw std::runtime_error("cannot write " + part_ + "; give --video a file in a writable folder");
  try {
    encoder_.emplace(encoder_command(part_, width, height, settings.rate_Hz, settings.video_crf));
  } catch (...) {
    std::filesystem::remove(part_, none);
    throw;
  }
}

VideoFile::~VideoFile() {
  encoder_.reset();
  std::error_code none;
  if (!finished_) std::filesystem::remove(part_, none);
}

void VideoFile::write(std::span<const std::uint8_t> rgba) {
  newest_ = hash_of(rgba);
  pixels_ = sync::fnv1a_64(pixels_, &newest_, sizeof newest_);
  rgba_to_i420(rgba, width_, height_, planes_);
  if (!encoder_->write(planes_))
    throw std::runtime_error("the encoder of " + file_ + " has died; is the disk full?");
  ++frames_;
}

void VideoFile::finish() {
  const bool whole = encoder_->finish();
  std::error_code error;
  if (whole) std::filesystem::rename(part_, file_, error);
  if (!whole || error)
    throw std::runtime_error("cannot finish " + file_ + " (" + (whole ? error.message() : "its encoder failed") +
                             "); free disk space or choose another --video");
  finished_ = true;
}

}  // namespace tactus::visual
