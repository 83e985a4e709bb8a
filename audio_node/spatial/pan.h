// Stereo panning of a source between two loudspeakers. Pure.
#pragma once

#include <cmath>
#include <numbers>

#include "audio_node/spatial/source_position.h"

namespace tactus::audio {

struct StereoGain {
  float left, right;
};

// 1/r, and equal power by the azimuth.
inline StereoGain pan(const SourcePosition& place) {
  const float level = std::hypot(place.direction.x(), place.direction.y());
  const float to_left = level > 1e-6f ? place.direction.y() / level : 0;  // sine of the azimuth
  const float angle = (1 - to_left) * std::numbers::pi_v<float> / 4;
  return {std::cos(angle) / place.distance_m, std::sin(angle) / place.distance_m};
}

}  // namespace tactus::audio
