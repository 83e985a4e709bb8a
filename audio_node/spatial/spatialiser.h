// Spatial rendering of several sources: for two ears, for surrounding loudspeakers, or for a stereo pair. Pure.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "audio_node/modal/bank/ring.h"
#include "audio_node/spatial/source_position.h"
#include "audio_node/spatial/delay.h"
#include "audio_node/spatial/distance.h"
#include "audio_node/spatial/fir.h"
#include "audio_node/spatial/hrtf.h"
#include "audio_node/spatial/panning.h"

namespace tactus::audio {

// Maximum latency of rendering for ears, frames: the lead of the filters and the minimum delay.
inline constexpr int kMaxEarsLatency = Hrtf::kLead + kMinDelay;

// Data shared by all sources. When both members are null: two channels, panned with equal power by the azimuth
// (pan.h).
struct Space {
  std::shared_ptr<const Hrtf> hrtf;
  std::shared_ptr<const Panning> panning;

  int channels() const { return panning && !hrtf ? panning->channels() : 2; }
  // Latency from input to output, frames, for any direction; the further ear has an additional delay.
  int latency() const { return hrtf ? hrtf->onset_samples() + kMinDelay : 0; }
};

// A fixed number of sources, each one mono signal. Directions and distances change within a block, without a
// click. Realtime-safe: yes, except the constructor.
class Spatialiser {
 public:
  Spatialiser(const Space& space, int sources, double rate_Hz, Instructions instructions);

  int channels() const { return channels_; }
  // Frames of output that remain after the last input of a source.
  int tail() const { return tail_; }
  // Begins another sound on that source: clears the state of the previous one.
  void begin(int source);
  // Adds the next `frames` <= kMaxBlock frames of a source. The source is at `place` at the end of the block. All
  // sources of a block have the same number of frames.
  void add(int source, const SourcePosition& place, const float* mono, int frames);
  // Adds the block to `mix`, channels interleaved, and begins the next block.
  void mix(float* mix, int frames);

 private:
  struct Source {
    explicit Source(double rate_Hz) : distance(rate_Hz) {}
    Distance distance;
    bool fresh = true;
    bool rested = true;  // it did not turn in the previous block
    Eigen::Vector3f direction = Eigen::Vector3f::Zero();
    std::array<float, kMaxChannels> gains{};
    float interaural_delay = 0;
    // Only for ears: the filters in use, and the previous input and output.
    std::vector<float> left, right, input, filtered_left, filtered_right;
  };
  void add_by_ears(Source& source, const float* sound, int frames, bool turned);
  void add_by_gains(Source& source, const float* sound, int frames, bool turned);
  void gains(const Eigen::Vector3f& direction, float* of_channels) const;
  float* bus(int channel) { return buses_.data() + channel * kMaxBlock; }

  Space space_;
  int channels_, tail_ = 0, taps_ = 0, past_ = 0;
  Fir fir_;
  std::vector<float> buses_;
  std::vector<float> next_left_, next_right_;
  std::vector<Source> sources_;
};

}  // namespace tactus::audio
