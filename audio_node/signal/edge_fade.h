// Fades the output in after an interruption and out before an end, so that neither is a click. Pure.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tactus::audio {

// Raised cosines of 5 ms (design: shorter is audible as a click). Unchanged samples otherwise. Realtime-safe: yes.
class EdgeFade {
 public:
  explicit EdgeFade(double rate_Hz)
      : length_(std::max(1, static_cast<int>(std::lround(kFade_s * rate_Hz)))), at_(length_) {}

  // The next samples begin at silence.
  void restart() { at_ = 0; }
  // The next samples fall to silence, and stay there.
  void end() { ends_ = true; }
  bool ended() const { return ends_ && at_ == 0; }

  // In place, channels interleaved.
  void apply(float* samples, int frames, int channels) {
    for (int n = 0; n < frames; ++n) {
      at_ = std::clamp(at_ + (ends_ ? -1 : 1), 0, length_);
      if (at_ == length_) continue;
      const double share = static_cast<double>(at_) / length_;
      const auto gain = static_cast<float>((1 - std::cos(std::numbers::pi * share)) / 2);
      for (int c = 0; c < channels; ++c) samples[channels * n + c] *= gain;
    }
  }

 private:
  static constexpr double kFade_s = 0.005;
  int length_;
  int at_;  // position in the edge, samples: 0 silent, length_ open
  bool ends_ = false;
};

}  // namespace tactus::audio
