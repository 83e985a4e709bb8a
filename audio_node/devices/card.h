// What the output plays on: a sound card, or a file that a log is rendered into.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "audio_node/mixer/capture.h"
#include "audio_node/mixer/renderer.h"

namespace tactus::audio {

struct StreamOptions {
  std::string device =
      "default";  // default: a real card, else the virtual one; virtual; or part of a device's name
  int rate_Hz = 48000;
  int period_frames = 128;
  double latency_periods = 2;  // asked of the card; more is safer and later
  std::string folder = ".";    // where audio.wav goes
  int fifo_priority = 0;       // of the callback, where the process runs under FIFO; 0: leave it
  int channels = 2;
};

class Card {
 public:
  // Fills frames, channels interleaved.
  using Render = std::function<void(float* out, int frames, const BlockTime& time)>;

  virtual ~Card() = default;

  // False when it has gone.
  virtual bool alive(sync::HostTime now) const = 0;
  // Once a tick. A real card plays by itself.
  virtual void play_until(sync::HostTime) {}
  virtual std::int64_t callbacks() const = 0;
  virtual std::int64_t underflows() const = 0;
  virtual const std::string& card() const = 0;    // name for people
  virtual const std::string& medium() const = 0;  // name of the WAV file
  virtual std::optional<MediaPair> next_pair() = 0;
};

// Throws std::runtime_error with one sentence.
using OpenCard = std::function<std::unique_ptr<Card>(const StreamOptions&, Card::Render)>;

}  // namespace tactus::audio
