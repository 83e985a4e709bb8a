#include "audio_node/signal/level_limiter.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace tactus::audio {
namespace {

constexpr double kSinePower = 0.5;      // of a sine at full scale
constexpr double kReference_Pa = 2e-5;  // of sound pressure level, ISO 1683
constexpr double kSecond_s = 1;         // over which the level is averaged

constexpr double kBlock_s = 0.01;  // design: a hundred blocks hold a second to 1 %, 0.04 dB
// Share of the limit that is always available: 3 dB below it, since silence would sound like a fault. Design.
constexpr double kFloor = 0.5;
// The surplus that is left may be spent within this time: 9 dB above the limit after silence. Design.
constexpr double kBurst_s = 0.0625;
// Share of the surplus for the gain to plan with. The rest is for errors of its estimate of the power. Design.
constexpr double kPlanned = 0.95;
// The gain rises until the level is this share of the one that can last. Design: beats and noise stay below it
// too.
constexpr double kSettled = 0.95;
// Share of the surplus that a low tone may take by its sudden end. Design.
constexpr double kEnd = 0.5;
// Mean power of the input. Design: half a period of 50 Hz, whose A-weighted level is 30 dB lower than that of 1
// kHz.
constexpr double kFast_s = 0.01;
// 0.05 dB a sample at 48 kHz, half as steep as the ramp of the peak limiter: 5 ms for 12 dB. Slow rise: pumping is
// audible above about 10 dB a second. Design.
constexpr double kFall_dB_s = 2400, kRise_dB_s = 10;
// Each sample takes at most its part of this time of the remaining energy. This acts only at onsets of sound that
// is more than 14 dB above the allowed level. Design.
constexpr double kSpend_s = 0.002;
// The gain rises again from here, -100 dB.
constexpr double kLeastGain = 1e-5;

double from_dB(double level_dB) { return std::pow(10, level_dB / 10); }

}  // namespace

LevelLimiter::LevelLimiter(const LevelLimiterDef& def, double rate_Hz, int channels)
    : Pa2_per_power_(kReference_Pa * kReference_Pa * from_dB(def.full_scale_dB) / kSinePower),
      period_s_(1 / rate_Hz),
      fall_(std::pow(10, -kFall_dB_s / 20 / rate_Hz)),
      rise_(std::pow(10, kRise_dB_s / 20 / rate_Hz)),
      fast_step_(1 - std::exp(-1 / (kFast_s * rate_Hz))),
      spent_share_(std::min(1.0, 1 / (kSpend_s * rate_Hz))),
      ears_(def.ears),
      channels_(static_cast<std::size_t>(channels)),
      block_frames_(std::max(1, static_cast<int>(std::lround(kBlock_s * rate_Hz)))),
      burst_frames_(kBurst_s * rate_Hz),
      tail_(rate_Hz),
      input_(channels_, AWeighting(rate_Hz)),
      output_(channels_, AWeighting(rate_Hz)) {
  const double limit = kSinePower * from_dB(def.limit_dB - def.full_scale_dB);
  const int second = static_cast<int>(std::lround(kSecond_s * rate_Hz));
  // A second that ends within a block overlaps this number of earlier ones.
  surpluses_.assign(static_cast<std::size_t>((second + block_frames_ - 2) / block_frames_), 0.0);
  floor_power_ = kFloor * limit;
  floor_ = floor_power_ * block_frames_;
  const double blocks = static_cast<double>(surpluses_.size()) + 1;
  surplus_limit_ = limit * second - floor_ * blocks;
  surpluses_.back() = surplus_ = std::clamp(def.spent_Pa2_s / (Pa2_per_power_ * period_s_), 0.0, surplus_limit_);
  // Power p that can last: the surplus (p - floor) of a second leaves what allows p.
  settled_power_ =
      kSettled * (floor_power_ + kPlanned * surplus_limit_ / (blocks * block_frames_ + burst_frames_));
}

double LevelLimiter::slope(std::span<const float> frame, const std::vector<AWeighting>& filters) const {
  double sum = 0;
  for (std::size_t c = 0; c < channels_; ++c) sum += static_cast<double>(frame[c]) * tail_.slope(filters[c]);
  return sum;
}

double LevelLimiter::tails(const std::vector<AWeighting>& filters) const {
  double sum = 0;
  for (const AWeighting& filter : filters) sum += tail_.energy(filter);
  return sum;
}

LevelLimiter::Energy LevelLimiter::filter(std::span<const float> frame, std::vector<AWeighting>& filters) const {
  Energy e;
  double loudest = 0, square = 0;
  e.change = 2 * slope(frame, filters);
  for (std::size_t c = 0; c < channels_; ++c) {
    const double x = static_cast<double>(frame[c]), weighted = filters[c].next(x);
    square += x * x;
    loudest = std::max(loudest, weighted * weighted), e.all += weighted * weighted;
  }
  e.change += tail_.square() * square;
  e.counted = ears_ ? loudest : e.all;
  return e;
}

double LevelLimiter::next_gain() const {
  const double left = std::max(0.0, kPlanned * surplus_limit_ - surplus_ - std::max(0.0, block_energy_ - floor_));
  const double allowed = floor_power_ + left / burst_frames_;
  double falls_to = fast_ > allowed ? std::sqrt(allowed / fast_) : 1;
  double rises_to = fast_ > settled_power_ ? std::sqrt(settled_power_ / fast_) : 1;
  if (const double end = kEnd * surplus_limit_; input_tail_ > end) {
    falls_to = std::min(falls_to, std::sqrt(end / input_tail_));
    rises_to = std::min(rises_to, falls_to);
  }
  if (gain_ > falls_to) return std::max(falls_to, gain_ * fall_);
  return std::max(gain_, std::min(rises_to, gain_ * rise_));
}

// The largest gain up to this one with which the energy of the second, and of its tail, takes only its part of
// the remaining energy. The energy that this sample adds is 2 gain slope + gain^2 square.
double LevelLimiter::within_budget(double gain, std::span<const float> frame) const {
  const double left = floor_ + surplus_limit_ - surplus_ - block_energy_ - output_tail_;
  const double allowed = spent_share_ * std::max(0.0, left);
  double square = 0;
  for (const float x : frame) square += static_cast<double>(x) * static_cast<double>(x);
  square *= tail_.square();
  const double along = slope(frame, output_);
  if (!(2 * gain * along + gain * gain * square > allowed)) return gain;
  const double root = std::sqrt(along * along + square * allowed);
  const double largest = along > 0 ? allowed / (along + root) : (root - along) / square;
  return std::min(gain, largest);
}

void LevelLimiter::end_block() {
  surpluses_[oldest_] = std::max(0.0, block_energy_ - floor_);
  oldest_ = (oldest_ + 1) % surpluses_.size();
  surplus_ = std::accumulate(surpluses_.begin(), surpluses_.end(), 0.0);
  block_energy_ = 0, frames_ = 0;
  input_tail_ = tails(input_), output_tail_ = tails(output_);  // prevents drift by rounding
}

void LevelLimiter::process(float* samples, int frames) {
  for (int n = 0; n < frames; ++n) {
    const std::span<float> frame(samples + static_cast<std::size_t>(n) * channels_, channels_);
    for (float& x : frame) x = std::isfinite(x) ? std::clamp(x, -1.f, 1.f) : 0;
    const Energy in = filter(frame, input_);
    input_tail_ += in.change - in.all;
    fast_ += (in.counted - fast_) * fast_step_;
    const double gain = within_budget(next_gain(), frame);
    gain_ = std::max(gain, kLeastGain);
    if (gain < 1)
      for (float& x : frame) x = static_cast<float>(static_cast<double>(x) * gain);
    const Energy out = filter(frame, output_);
    output_tail_ += out.change - out.all;
    block_energy_ += out.counted;
    exposure_ += out.counted;
    if (++frames_ == block_frames_) end_block();
  }
}

double LevelLimiter::spent_Pa2_s() const {
  return (surplus_ + std::max(0.0, block_energy_ + output_tail_ - floor_)) * Pa2_per_power_ * period_s_;
}

double LevelLimiter::take_exposure_Pa2_s() { return std::exchange(exposure_, 0) * Pa2_per_power_ * period_s_; }

}  // namespace tactus::audio
