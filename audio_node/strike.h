// What crosses into the audio callback: one impact, by value, with all that is needed to sound it.
#pragma once

#include <array>
#include <cstdint>

#include "sync/time.h"

namespace tactus::audio {

inline constexpr int kMaxModes = 32;
inline constexpr int kLanes = 8;  // modes are computed in groups of so many

// Resonators of one body at one sample rate: the pole exp((-d + i w_d) / fs) of each mode and its response to a
// unit impulse, Pa at 1 m per N s. Unused modes up to a multiple of kLanes are zero.
struct Resonators {
  int count = 0;
  std::array<float, kMaxModes> pole_re{}, pole_im{}, response{};
};

// One of the two bodies of an impact.
struct StrikeSide {
  std::int64_t voice = -1;  // the same for the same body: it is excited again without losing its state; -1: none
  Resonators resonators;
  float impulse = 0;  // N s, scaled to full scale per Pa
  float click = 0;    // response to the change of a unit-sum pulse from one sample to the next (rigid body's jerk)
  float left = 0, right = 0;  // loudspeaker gains: distance and direction
};

struct Strike {
  std::int64_t event_id = 0;
  sync::HostTime scheduled{};
  int pulse_samples = 1;  // length of the raised-cosine force pulse
  float heard_from = 0;   // factor on its strength below which it is too weak to be heard, by prediction
  std::array<StrikeSide, 2> sides;
};

}  // namespace tactus::audio
