// Head-related filters for each direction at one sample rate: filters without their delay, and the interaural
// delay. Pure.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "audio_node/spatial/sofa.h"

namespace tactus::audio {

// A grid of directions. Filters are interpolated between measured directions and between grid nodes with their
// onsets aligned, so that no comb filter arises.
class Hrtf {
 public:
  // Frames of a filter before its onset (a fifth of its peak). The same for all filters, so that they can be
  // mixed.
  static constexpr int kLead = 16;

  // Takes a tenth of a second: do not call it on a real-time thread. Throws std::runtime_error with one sentence
  // when the directions do not surround the head.
  Hrtf(const MeasuredHrtf& measured, double rate_Hz);

  // Length of one filter, a multiple of 16.
  int taps() const { return taps_; }
  // Frames from the beginning of the filters to the first audible sample at the nearer ear (onset.h), mean over
  // all directions: the latency of the filters.
  int onset_samples() const { return onset_samples_; }
  // Upper bound of the interaural delay, samples.
  float max_delay() const { return max_delay_; }

  // The filters of a direction. Returns the delay of the left ear relative to the right, samples (negative:
  // earlier). Straight ahead the two filters together have energy 1. Realtime-safe: yes.
  float at(const Eigen::Vector3f& direction, float* left, float* right) const;

 private:
  static constexpr int kStep_deg = 5;  // of the grid; the resolution of the KEMAR measurement at ear height
  static constexpr int kAzimuths = 360 / kStep_deg, kElevations = 180 / kStep_deg + 1;

  std::size_t node(int azimuth, int elevation) const;
  int mean_onset() const;
  const float* filters(std::size_t node) const {
    return filters_.data() + node * 2 * static_cast<std::size_t>(taps_);
  }

  int taps_;
  std::vector<float> filters_;  // of each node: left, right
  std::vector<float> delays_;   // of each node: left after right, samples
  float max_delay_ = 0;
  int onset_samples_ = 0;
};

}  // namespace tactus::audio
