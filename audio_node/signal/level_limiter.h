// Keeps the level at the ears, averaged over a second, within a limit, and counts the dose that they take. Pure.
#pragma once

#include <span>
#include <vector>

#include "audio_node/signal/a_weighting.h"

namespace tactus::audio {

struct HearingDef {
  double full_scale_dB = 100;  // SPL of a full-scale sine at the ear
  double limit_dB = 85;        // A-weighted
  // Each ear has its own channel, and the louder one counts. Else the channels are loudspeakers that both ears
  // hear: their powers add up, as those of a source between them do.
  bool ears = false;
};

// Follows the limiter of peaks, so that it measures just what is played. Below the limit it changes no bit, and it
// never delays. The level is the mean of A-weighted power with the time weighting S; what is over the limit is
// turned down by a gain that moves slowly: also a full-scale tone out of silence is within the limit after
// kSettled_s. Its first moments are over it, as those of a blow are: by up to 9 dB while the mean is low.
// Realtime-safe: yes, all but the constructor.
class LevelLimiter {
 public:
  static constexpr double kSettled_s = 3;

  LevelLimiter(const HearingDef& def, double rate_Hz, int channels);
  // In place, channels interleaved. All channels get one gain. No number becomes silence, what is beyond full
  // scale full scale.
  void process(float* samples, int frames);

  double gain() const { return gain_; }
  // A-weighted sound exposure at the ears (IEC 61672-1, 3.12) since it was asked for last.
  double take_exposure_Pa2_s();

 private:
  // IEC 61672-1, 3.6: time weightings S and F.
  static constexpr double kSlow_s = 1, kFast_s = 0.125;
  // So much more than the limit the fast mean may be while the slow one is low: what fills it in kFast_s.
  static constexpr double kBurst = kSlow_s / kFast_s;
  // Where too much was played the fast mean is held at this share of the limit until the slow one has fallen:
  // 3 dB, since silence would be heard as a fault. Design.
  static constexpr double kPenance = 0.5;
  // 0.004 dB a sample at 48 kHz: no click; from full scale to the limit within 0.1 s. Up again slowly: pumping is
  // heard above some 10 dB a second. Design.
  static constexpr double kFall_dB_s = 200, kRise_dB_s = 10;

  double power_of(std::span<const float> frame);
  double wanted_gain() const;

  double limit_, Pa2_per_power_, slow_step_, fast_step_, fall_, rise_, period_s_;
  bool ears_;
  std::size_t channels_;
  std::vector<AWeighting> weighting_;
  double slow_ = 0;  // mean power of what is played
  double fast_ = 0;  // of what comes
  double gain_ = 1, exposure_ = 0;
};

}  // namespace tactus::audio
