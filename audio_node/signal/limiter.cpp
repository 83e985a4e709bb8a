#include "audio_node/signal/limiter.h"

#include <algorithm>
#include <cmath>

namespace tactus::audio {
namespace {

std::size_t slot(std::int64_t i) { return static_cast<std::size_t>(i % Limiter::kLookAhead); }
float finite(float x) { return std::isfinite(x) ? x : 0; }

}  // namespace

Limiter::Limiter(double ceiling, double rate_Hz, int channels)
    : ceiling_(static_cast<float>(ceiling)),
      release_(static_cast<float>(1 - std::exp(-1 / (kRelease_s * rate_Hz)))),
      channels_(static_cast<std::size_t>(channels)),
      delayed_(channels_ * kLookAhead) {
  gains_.fill(1);
}

// Expired candidates leave before the new one enters: the ring has room for exactly one window.
float Limiter::smallest_in_window(float target) {
  if (front_ < back_ && ends_[slot(front_)] <= count_) ++front_;
  while (back_ > front_ && values_[slot(back_ - 1)] >= target) --back_;
  values_[slot(back_)] = target;
  ends_[slot(back_)] = count_ + kLookAhead;
  ++back_;
  return values_[slot(front_)];
}

void Limiter::process(float* samples, int frames) {
  for (int n = 0; n < frames; ++n, ++count_) {
    float* const frame = samples + static_cast<std::size_t>(n) * channels_;
    float peak = 0;
    for (std::size_t c = 0; c < channels_; ++c) peak = std::max(peak, std::abs(frame[c] = finite(frame[c])));
    const float needed = smallest_in_window(peak > ceiling_ ? ceiling_ / peak : 1);
    gain_ = std::min(needed, gain_ + (1 - gain_) * release_);

    // Mean of the last kLookAhead gains: each of them took the current output sample into account, so none is too
    // large for it.
    float& oldest = gains_[slot(count_)];
    sum_ += static_cast<double>(gain_) - static_cast<double>(oldest);
    oldest = gain_;
    if (slot(count_) == 0) {  // prevents drift by rounding
      sum_ = 0;
      for (const float g : gains_) sum_ += static_cast<double>(g);
    }
    const float gain = static_cast<float>(sum_ / kLookAhead);

    float* const in = delayed_.data() + channels_ * slot(count_);
    const float* const out = delayed_.data() + channels_ * slot(count_ + 1);
    for (std::size_t c = 0; c < channels_; ++c) {
      in[c] = frame[c];
      frame[c] = std::clamp(out[c] * gain, -ceiling_, ceiling_);
    }
  }
}

}  // namespace tactus::audio
