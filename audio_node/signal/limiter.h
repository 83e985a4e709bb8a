// Peak limiter: keeps every sample within a ceiling, for any input. Pure.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace tactus::audio {

// Looks ahead: a linear ramp reaches the gain of the loudest sample before that sample leaves, so that nothing is
// clipped. Below the ceiling it is an exact delay of kDelay frames. NaN and infinity become silence.
// Realtime-safe: yes.
class Limiter {
 public:
  // 1.3 ms at 48 kHz: long enough for a ramp that is not audible as a click, short enough for the presentation
  // delay. A power of two, so that a mean of ones is 1.
  static constexpr int kLookAhead = 64;
  static constexpr int kDelay = kLookAhead - 1;

  Limiter(double ceiling, double rate_Hz, int channels = 2);
  // In place, channels interleaved: the output is the input of kDelay frames before. One gain for all channels.
  void process(float* samples, int frames);
  // Clears the input of the last kDelay frames.
  void clear() { std::fill(delayed_.begin(), delayed_.end(), 0.f); }

 private:
  // Time constant of the release, 50 ms: a shorter one is audible as distortion of low tones (Giannoulis,
  // Massberg, Reiss, J. Audio Eng. Soc. 60, 2012, section 1.3).
  static constexpr double kRelease_s = 0.05;

  float smallest_in_window(float target);

  float ceiling_;
  float release_;
  float gain_ = 1;
  double sum_ = kLookAhead;
  std::int64_t count_ = 0;
  std::size_t channels_;
  std::vector<float> delayed_;
  std::array<float, kLookAhead> gains_;
  // Monotonic queue of candidates for the minimum of the window: values and expiry.
  std::array<float, kLookAhead> values_{};
  std::array<std::int64_t, kLookAhead> ends_{};
  std::int64_t front_ = 0, back_ = 0;
};

}  // namespace tactus::audio
