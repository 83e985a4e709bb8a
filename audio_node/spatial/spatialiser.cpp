#include "audio_node/spatial/spatialiser.h"

#include <algorithm>
#include <cmath>

#include "audio_node/spatial/pan.h"

namespace tactus::audio {
namespace {

// A source that has turned by less keeps its filters: a tenth of a degree, the resolution of hearing at best
// (Mills, J. Acoust. Soc. Am. 30, 1958), so that tremor of a tracked head does not cost new filters in each block.
constexpr float kMinTurn_rad = 0.00175f;

// A place that is not finite counts as straight ahead.
const SourcePosition kStraightAhead;

}  // namespace

Spatialiser::Spatialiser(const Space& space, int sources, double rate_Hz, Instructions instructions)
    : space_(space), channels_(space.channels()), fir_(fir(instructions)) {
  buses_.resize(static_cast<std::size_t>(channels_ * kMaxBlock));
  sources_.assign(static_cast<std::size_t>(sources), Source(rate_Hz));
  if (!space.hrtf) return;
  taps_ = space.hrtf->taps();
  past_ = static_cast<int>(std::ceil(space.hrtf->max_delay())) + kMinDelay + kDelayReach;
  tail_ = taps_ + past_;
  const auto taps = static_cast<std::size_t>(taps_), past = static_cast<std::size_t>(past_);
  next_left_.resize(taps), next_right_.resize(taps);
  for (Source& s : sources_) {
    s.left.resize(taps), s.right.resize(taps);
    s.input.resize(taps + kMaxBlock);
    // One more sample, which a delay of a whole number of samples reads with weight 0.
    s.filtered_left.resize(past + kMaxBlock + 1), s.filtered_right.resize(past + kMaxBlock + 1);
  }
}

void Spatialiser::begin(int source) {
  Source& s = sources_[static_cast<std::size_t>(source)];
  s.fresh = true;
  s.distance.begin();
  for (auto* past : {&s.input, &s.filtered_left, &s.filtered_right}) std::fill(past->begin(), past->end(), 0.f);
}

void Spatialiser::add(int source, const SourcePosition& requested, const float* mono, int frames) {
  const bool is_place = requested.direction.allFinite() && requested.distance_m > 0 && std::isfinite(requested.distance_m);
  const SourcePosition& place = is_place ? requested : kStraightAhead;
  Source& s = sources_[static_cast<std::size_t>(source)];
  std::array<float, kMaxBlock> sound;
  s.distance.apply(mono, place.distance_m, frames, sound.data());
  // Filters change in at most every second block, because new filters double the cost.
  const bool moved = (place.direction - s.direction).squaredNorm() > kMinTurn_rad * kMinTurn_rad;
  const bool turned = s.fresh || (moved && s.rested);
  s.rested = !turned;
  if (turned) s.direction = place.direction;
  if (space_.hrtf)
    add_by_ears(s, sound.data(), frames, turned);
  else
    add_by_gains(s, sound.data(), frames, turned);
  s.fresh = false;
}

// Filter, then delay: the filters of both ears read the same input. When the direction changes, the output
// crossfades from the old filters to the new ones.
void Spatialiser::add_by_ears(Source& s, const float* sound, int frames, bool turned) {
  float* const input = s.input.data() + taps_;
  std::copy(sound, sound + frames, input);
  float* const left = s.filtered_left.data() + past_;
  float* const right = s.filtered_right.data() + past_;
  const float delay_before = s.interaural_delay;
  if (turned) s.interaural_delay = space_.hrtf->at(s.direction, next_left_.data(), next_right_.data());
  if (s.fresh) std::swap(s.left, next_left_), std::swap(s.right, next_right_);
  std::array<float, kMaxBlock> new_left, new_right;
  const float* const filters[] = {s.left.data(), s.right.data(), next_left_.data(), next_right_.data()};
  float* const filtered[] = {left, right, new_left.data(), new_right.data()};
  const bool crossfades = turned && !s.fresh;
  fir_(input, filters, crossfades ? 4 : 2, taps_, filtered);
  if (crossfades) {
    for (int n = 0; n < frames; ++n) {
      const auto i = static_cast<std::size_t>(n);
      const float share = static_cast<float>(n + 1) / static_cast<float>(frames);
      left[n] += share * (new_left[i] - left[n]);
      right[n] += share * (new_right[i] - right[n]);
    }
    std::swap(s.left, next_left_), std::swap(s.right, next_right_);
  }
  // The nearer ear has no additional delay.
  const auto delay = [](float by) { return static_cast<float>(kMinDelay) + std::max(0.f, by); };
  const float from = s.fresh ? s.interaural_delay : delay_before;
  add_delayed(left, delay(from), delay(s.interaural_delay), frames, bus(0));
  add_delayed(right, delay(-from), delay(-s.interaural_delay), frames, bus(1));
  std::copy(input + frames - taps_, input + frames, s.input.begin());
  std::copy(left + frames - past_, left + frames, s.filtered_left.begin());
  std::copy(right + frames - past_, right + frames, s.filtered_right.begin());
}

void Spatialiser::gains(const Eigen::Vector3f& direction, float* of_channels) const {
  if (space_.panning) return space_.panning->gains(direction, of_channels);
  const auto [left, right] = pan({direction, 1});
  of_channels[0] = left, of_channels[1] = right;
}

// Gains change linearly to their values at the end of the block.
void Spatialiser::add_by_gains(Source& s, const float* sound, int frames, bool turned) {
  std::array<float, kMaxChannels> wanted = s.gains;
  if (turned) gains(s.direction, wanted.data());
  if (s.fresh) s.gains = wanted;
  for (int c = 0; c < channels_; ++c) {
    float& gain = s.gains[static_cast<std::size_t>(c)];
    const float to = wanted[static_cast<std::size_t>(c)];
    if (gain == 0 && to == 0) continue;
    const float step = (to - gain) / static_cast<float>(frames);
    float* const out = bus(c);
    for (int n = 0; n < frames; ++n) out[n] += (gain + step * static_cast<float>(n + 1)) * sound[n];
    gain = to;
  }
}

void Spatialiser::mix(float* mix, int frames) {
  for (int c = 0; c < channels_; ++c)
    for (int n = 0; n < frames; ++n) mix[channels_ * n + c] += bus(c)[n];
  std::fill(buses_.begin(), buses_.end(), 0.f);
}

}  // namespace tactus::audio
