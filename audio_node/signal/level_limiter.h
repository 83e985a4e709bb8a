// Keeps the level at the ears, averaged over a second, within a limit, and accumulates the sound exposure. Pure.
#pragma once

#include <span>
#include <vector>

#include "audio_node/signal/a_weighting.h"

namespace tactus::audio {

struct LevelLimiterDef {
  double full_scale_dB = 100;  // SPL of a full-scale sine at the ear
  double limit_dB = 85;        // A-weighted
  // True: each ear has its own channel, and the louder one counts. False: the channels are loudspeakers for both
  // ears, and their powers add up, as those of a source between them do.
  bool ears = false;
};

// Follows the peak limiter, so that it measures the played sound. Below the limit it changes no bit, and it never
// delays. The level is the mean of A-weighted power with time weighting S. Above the limit a slowly moving gain
// reduces it: even a full-scale tone after silence is within the limit after kSettled_s. Its first moments exceed
// the limit, as those of a blow do, by up to 9 dB while the mean is low. Realtime-safe: yes, except the
// constructor.
class LevelLimiter {
 public:
  static constexpr double kSettled_s = 3;

  LevelLimiter(const LevelLimiterDef& def, double rate_Hz, int channels);
  // In place, channels interleaved, one gain for all channels. NaN and infinity become silence; values beyond full
  // scale are clamped.
  void process(float* samples, int frames);

  double gain() const { return gain_; }
  // A-weighted sound exposure at the ears (IEC 61672-1, 3.12) since the last call.
  double take_exposure_Pa2_s();

 private:
  // IEC 61672-1, 3.6: time weightings S and F.
  static constexpr double kSlow_s = 1, kFast_s = 0.125;
  // Factor by which the fast mean may exceed the limit while the slow one is low: it fills the slow mean in
  // kFast_s.
  static constexpr double kBurst = kSlow_s / kFast_s;
  // After an excess the fast mean is held at this share of the limit until the slow one has fallen: 3 dB, since
  // silence would sound like a fault. Design.
  static constexpr double kRecoveryShare = 0.5;
  // 0.004 dB a sample at 48 kHz: no click; from full scale to the limit within 0.1 s. Slow rise: pumping is
  // audible above about 10 dB a second. Design.
  static constexpr double kFall_dB_s = 200, kRise_dB_s = 10;

  double power_of(std::span<const float> frame);
  double wanted_gain() const;

  double limit_, Pa2_per_power_, slow_step_, fast_step_, fall_, rise_, period_s_;
  bool ears_;
  std::size_t channels_;
  std::vector<AWeighting> weighting_;
  double slow_ = 0;  // mean power of the output
  double fast_ = 0;  // of the input
  double gain_ = 1, exposure_ = 0;
};

}  // namespace tactus::audio
