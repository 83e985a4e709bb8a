// What the head does to a sound from each direction, ready to be heard at one rate: filters without their delay,
// and the delay between the ears beside them. Pure.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "audio_node/spatial/sofa.h"

namespace tactus::audio {

// A grid of directions. Between those that were measured, and between those of the grid, filters are mixed whose
// beginnings lie on one sample, so that nothing is cancelled by a comb.
class Hrtf {
 public:
  // Frames of a filter before a fifth of its peak, for what comes before that. The same for all, so that mixed
  // filters fit.
  static constexpr int kLead = 16;

  // Takes a tenth of a second: off the real-time threads. Throws std::runtime_error with one sentence when the
  // directions do not surround the head.
  Hrtf(const MeasuredHrtf& measured, double rate_Hz);

  // Of one filter, a multiple of 16.
  int taps() const { return taps_; }
  // Frames after the beginning of its filters at which the nearer ear first hears anything (onset.h), in the mean
  // over all directions: what makes a sound later whichever way it comes.
  int begins() const { return begins_; }
  // No interaural delay is longer, samples.
  float longest_delay() const { return longest_delay_; }

  // The filters from a direction, and by how many samples the left ear hears later than the right (negative:
  // earlier). Straight ahead the two filters have energy 1 together. Realtime-safe: yes.
  float at(const Eigen::Vector3f& direction, float* left, float* right) const;

 private:
  static constexpr int kStep_deg = 5;  // of the grid; as finely as KEMAR was measured at the height of the ears
  static constexpr int kAzimuths = 360 / kStep_deg, kElevations = 180 / kStep_deg + 1;

  std::size_t node(int azimuth, int elevation) const;
  int mean_beginning() const;
  const float* filters(std::size_t node) const {
    return filters_.data() + node * 2 * static_cast<std::size_t>(taps_);
  }

  int taps_;
  std::vector<float> filters_;  // of each node: left, right
  std::vector<float> delays_;   // of each node: left after right, samples
  float longest_delay_ = 0;
  int begins_ = 0;
};

}  // namespace tactus::audio
