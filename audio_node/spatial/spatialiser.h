// From where each of several sources is heard: by two ears, by loudspeakers around, or by two in front. Pure.
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

// Ears hear no later than so many frames after what went in: the lead of the filters and the least delay.
inline constexpr int kMaxEarsLatency = Hrtf::kLead + kLeastDelay;

// What all sources share. Two channels and equal power by the azimuth (pan.h) where there is neither of the two.
struct Space {
  std::shared_ptr<const Hrtf> hrtf;
  std::shared_ptr<const Panning> panning;

  int channels() const { return panning && !hrtf ? panning->channels() : 2; }
  // Frames by which what is heard comes after what went in, wherever it comes from; the ear that is further away
  // hears it later still.
  int latency() const { return hrtf ? hrtf->begins() + kLeastDelay : 0; }
};

// A fixed number of sources, each one mono signal. Directions and distances go over within a block, without a
// click. Realtime-safe: yes, all but the constructor.
class Spatialiser {
 public:
  Spatialiser(const Space& space, int sources, double rate_Hz, Instructions instructions);

  int channels() const { return channels_; }
  // Of a source of which nothing comes any more, so many frames are still to be heard.
  int tail() const { return tail_; }
  // Another sound begins on that source: nothing of the one before is heard.
  void begin(int source);
  // The next `frames` <= kMaxBlock frames of a source, heard from there at their end. The same number for all
  // sources of a block.
  void add(int source, const SourcePosition& place, const float* mono, int frames);
  // Adds the block to `mix`, channels interleaved; the next block begins.
  void mix(float* mix, int frames);

 private:
  struct Source {
    explicit Source(double rate_Hz) : distance(rate_Hz) {}
    Distance distance;
    bool fresh = true;
    bool rested = true;  // in the block before it stayed where it was
    Eigen::Vector3f direction = Eigen::Vector3f::Zero();
    std::array<float, kMaxChannels> gains{};
    float left_later = 0;
    // Of ears: the filters in use, and the past of what went in and of what came out.
    std::vector<float> left, right, input, heard_left, heard_right;
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
