// Keeps the level at the ears, averaged over any second, within a limit, and accumulates the sound exposure. Pure.
#pragma once

#include <span>
#include <vector>

#include "audio_node/signal/a_weighting.h"
#include "audio_node/signal/weighted_tail.h"

namespace tactus::audio {

struct LevelLimiterDef {
  double full_scale_dB = 100;  // SPL of a full-scale sine at the ear
  double limit_dB = 85;        // A-weighted, equivalent level of any second
  // True: each ear has its own channel, and the louder one counts. False: the channels are loudspeakers for both
  // ears, and their powers add up, as those of a source between them do.
  bool ears = false;
  // Exposure of the last second beyond its floor, of the limiter before this one (spent_Pa2_s): a new limiter
  // continues with it, so that the limit holds across both.
  double spent_Pa2_s = 0;
};

// Follows the peak limiter, so that it measures the played sound. It never delays, and changes no bit of steady
// sound that is half a decibel below the limit or quieter.
//
// The A-weighted energy of every second (L_Aeq,1s of IEC 61672-1, 3.9), from the first sample on and also when the
// sound stops at any moment, is at most that of the limit, for any input. Half of it is always available: the
// floor. Energy of a block of 10 ms beyond the floor is surplus, and the surplus of all blocks of a second has a
// limit too. A gain that falls with the surplus lets a blow through: 9 dB above the limit at first. A tone that
// continues is 3 dB below it until its onset is a second old, and then within a decibel. Realtime-safe: yes,
// except the constructor.
class LevelLimiter {
 public:
  static constexpr double kSettled_s = 3;

  LevelLimiter(const LevelLimiterDef& def, double rate_Hz, int channels);
  // In place, channels interleaved, one gain for all channels. NaN and infinity become silence; values beyond full
  // scale are clamped.
  void process(float* samples, int frames);

  double gain() const { return gain_; }
  // A-weighted sound exposure beyond the floor within the last second, with the tail of the sound, Pa^2 s.
  double spent_Pa2_s() const;
  // A-weighted sound exposure at the ears (IEC 61672-1, 3.12) since the last call.
  double take_exposure_Pa2_s();

 private:
  // Sums over the channels of one frame. Sums of squares.
  struct Energy {
    double counted = 0;  // of the A-weighted sound: the louder ear, or all loudspeakers
    double change = 0;   // of all channels, with the tails of their filters
    double all = 0;      // of the A-weighted sound of all channels
  };
  double slope(std::span<const float> frame, const std::vector<AWeighting>& filters) const;
  Energy filter(std::span<const float> frame, std::vector<AWeighting>& filters) const;
  double tails(const std::vector<AWeighting>& filters) const;
  double next_gain() const;
  double within_budget(double gain, std::span<const float> frame) const;
  void end_block();

  double Pa2_per_power_, period_s_, fall_, rise_, fast_step_, spent_share_;
  bool ears_;
  std::size_t channels_;
  // Energies are sums of squares of samples.
  int block_frames_;            // 10 ms
  double floor_power_, floor_;  // of each sample, of each block
  double surplus_limit_;        // of all blocks that overlap one second
  double burst_frames_, settled_power_;
  WeightedTail tail_;
  std::vector<AWeighting> input_, output_;
  double input_tail_ = 0, output_tail_ = 0;
  std::vector<double> surpluses_;  // of the previous blocks
  std::size_t oldest_ = 0;
  double surplus_ = 0;       // their sum
  double block_energy_ = 0;  // of the current block
  int frames_ = 0;           // of the current block
  double fast_ = 0;          // mean power of the input
  double gain_ = 1, exposure_ = 0;
};

}  // namespace tactus::audio
