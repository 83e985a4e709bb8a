// A card that plays into a WAV file at a constant rate on a clock that is passed in: no thread, no clock, no
// underflow. The same calls at the same times give the same samples, to the bit.
#pragma once

#include <memory>
#include <vector>

#include "audio_node/devices/card.h"

struct sf_private_tag;

namespace tactus::audio {

class FileCard : public Card {
 public:
  // Its first sample is out at the first play_until(). Until finish() the file is WAV.part, which the destructor
  // removes, so that a file with the final name is complete. Throws std::runtime_error with one sentence when the
  // file cannot be made.
  FileCard(const StreamOptions& options, const std::string& wav, Render render);
  ~FileCard() override;
  FileCard(const FileCard&) = delete;
  FileCard& operator=(const FileCard&) = delete;

  bool alive(sync::HostTime) const override { return true; }
  // Renders every block that a card with this latency would have requested by then. Throws std::runtime_error with
  // one sentence when the file cannot be written.
  void play_until(sync::HostTime now) override;
  std::int64_t callbacks() const override { return blocks_; }
  std::int64_t underflows() const override { return 0; }
  const std::string& card() const override { return card_; }
  const std::string& medium() const override { return wav_; }
  std::optional<MediaPair> next_pair() override;

  // Completes the file and renames it to its final name; nothing can be played afterwards. Throws
  // std::runtime_error with one sentence when the file cannot be written.
  void finish();

  // Time at which the first sample was out.
  std::optional<sync::HostTime> start() const { return start_; }
  std::int64_t frames() const { return blocks_ * period_frames_; }

 private:
  sync::HostTime presentation_time(std::int64_t frame) const;

  std::string wav_, part_, card_ = "file";
  bool finished_ = false;
  int lock_ = -1;
  Render render_;
  int rate_Hz_, period_frames_;
  sync::Nanoseconds latency_;
  std::vector<float> block_;
  std::unique_ptr<sf_private_tag, int (*)(sf_private_tag*)> file_;
  std::optional<sync::HostTime> start_;
  std::int64_t blocks_ = 0, next_pair_frame_ = 0;
  std::optional<MediaPair> pair_;
};

}  // namespace tactus::audio
