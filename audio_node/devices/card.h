// Interface of the audio output: a sound card, or a file into which a log is rendered.
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
      "default";  // default: a real card, otherwise the virtual one; virtual; or part of a device name
  int rate_Hz = 48000;
  int period_frames = 128;
  double latency_periods = 2;  // requested from the card; more is safer and later
  std::string folder = ".";    // folder of audio.wav
  int fifo_priority = 0;       // of the callback, if the process runs under FIFO; 0: unchanged
  int channels = 2;
};

class Card {
 public:
  // Fills frames, channels interleaved.
  using Render = std::function<void(float* out, int frames, const BlockTime& time)>;

  virtual ~Card() = default;

  // False when the card is lost.
  virtual bool alive(sync::HostTime now) const = 0;
  // Call once per tick. A real card plays by itself.
  virtual void play_until(sync::HostTime) {}
  virtual std::int64_t callbacks() const = 0;
  virtual std::int64_t underflows() const = 0;
  virtual const std::string& card() const = 0;    // name for messages
  virtual const std::string& medium() const = 0;  // name of the WAV file
  virtual std::optional<MediaPair> next_pair() = 0;
  // Missing part of the WAV file, with its reason, as of the last call of next_pair(); empty: none.
  virtual std::string recording_fault() const { return ""; }
};

// Throws std::runtime_error with one sentence.
using OpenCard = std::function<std::unique_ptr<Card>(const StreamOptions&, Card::Render)>;

}  // namespace tactus::audio
