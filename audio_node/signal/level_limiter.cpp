#include "audio_node/signal/level_limiter.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tactus::audio {
namespace {

constexpr double kSinePower = 0.5;      // of a sine at full scale
constexpr double kReference_Pa = 2e-5;  // of sound pressure level, ISO 1683

double from_dB(double level_dB) { return std::pow(10, level_dB / 10); }

}  // namespace

LevelLimiter::LevelLimiter(const LevelLimiterDef& def, double rate_Hz, int channels)
    : limit_(kSinePower * from_dB(def.limit_dB - def.full_scale_dB)),
      Pa2_per_power_(kReference_Pa * kReference_Pa * from_dB(def.full_scale_dB) / kSinePower),
      slow_step_(1 - std::exp(-1 / (kSlow_s * rate_Hz))),
      fast_step_(1 - std::exp(-1 / (kFast_s * rate_Hz))),
      fall_(std::pow(10, -kFall_dB_s / 20 / rate_Hz)),
      rise_(std::pow(10, kRise_dB_s / 20 / rate_Hz)),
      period_s_(1 / rate_Hz),
      ears_(def.ears),
      channels_(static_cast<std::size_t>(channels)),
      weighting_(channels_, AWeighting(rate_Hz)) {}

double LevelLimiter::power_of(std::span<const float> frame) {
  double loudest = 0, all = 0;
  for (std::size_t c = 0; c < channels_; ++c) {
    const double weighted = weighting_[c].next(static_cast<double>(frame[c]));
    loudest = std::max(loudest, weighted * weighted), all += weighted * weighted;
  }
  return ears_ ? loudest : all;
}

// Within kFast_s the slow mean reaches slow + (gain^2 fast - slow) / kBurst, which must not exceed the limit.
double LevelLimiter::wanted_gain() const {
  const double allowed = std::max(kBurst * limit_ - (kBurst - 1) * slow_, kRecoveryShare * limit_);
  return fast_ <= allowed ? 1 : std::sqrt(allowed / fast_);
}

void LevelLimiter::process(float* samples, int frames) {
  for (int n = 0; n < frames; ++n) {
    const std::span<float> frame(samples + static_cast<std::size_t>(n) * channels_, channels_);
    for (float& x : frame) x = std::isfinite(x) ? std::clamp(x, -1.f, 1.f) : 0;
    const double power = power_of(frame);
    fast_ += (power - fast_) * fast_step_;
    gain_ = std::clamp(wanted_gain(), gain_ * fall_, std::min(1.0, gain_ * rise_));
    const double played = gain_ * gain_ * power;
    slow_ += (played - slow_) * slow_step_;
    exposure_ += played;
    if (gain_ < 1)
      for (float& x : frame) x = static_cast<float>(static_cast<double>(x) * gain_);
  }
}

double LevelLimiter::take_exposure_Pa2_s() { return std::exchange(exposure_, 0) * Pa2_per_power_ * period_s_; }

}  // namespace tactus::audio
