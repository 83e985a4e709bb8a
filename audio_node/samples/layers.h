// Recordings of one sound at several speeds, ready to play: in memory, at the rate of the card. Pure.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace tactus::audio {

enum class Interaction : std::uint8_t { kImpact, kScrape, kRoll };
inline constexpr std::array<Interaction, 3> kInteractions{Interaction::kImpact, Interaction::kScrape,
                                                          Interaction::kRoll};
// Name of its folder.
std::string name(Interaction interaction);

// One channel. A blow begins with its first sample; a loop continues from its last sample to its first.
struct Recording {
  std::vector<float> samples;
  float peak = 0, rms = 0;
};

struct Layer {
  double speed_m_s = 1;
  float gain = 1;  // makes it as loud as the fastest layer
  std::vector<Recording> takes;
};

inline constexpr int kMaxLayers = 8;  // of one sound (design)

// The recordings of one pair of materials and one interaction.
struct Layers {
  std::vector<Layer> by_speed;  // ascending, each with at least one take; at most kMaxLayers
  double size_m = 0.05;         // of the recorded object: radius of a ball of the same extent
};

// The two layers about a speed and their gains. The powers add up to 1, as for uncorrelated recordings
// (equal-power crossfade over the logarithm of the speed; design).
struct LayerMix {
  std::array<int, 2> layer{-1, -1};  // -1: none
  std::array<float, 2> gain{};
};
LayerMix mix_of(const Layers& layers, double speed_m_s);

// The same number gives the same take; different numbers are distributed evenly. Realtime-safe: yes.
const Recording& select_take(const Layer& layer, std::int64_t number);

}  // namespace tactus::audio
