// Picture quality: the steps of the quality ladder, and the resolution that a profile sets. Plain data.
#pragma once

#include <algorithm>
#include <array>

namespace tactus::visual {

struct Quality {
  double scale = 1;  // factor on width and height of the drawn scene, 0 .. 1; the result is scaled up to the picture
  int shadow_divisor = 1;  // divisor of the shadow map's edge, 1 or 2; 0: no shadows
  bool coarse = false;     // scaled up in blocks, flashes included; otherwise smoothly, with flashes drawn over it

  bool operator==(const Quality&) const = default;
};

// Each step costs a software renderer clearly less than the previous one:
// tests/bench/visual_node/picture_quality.cpp.
inline constexpr std::array<Quality, 4> kQualities{
    {{1, 1, false}, {0.75, 2, false}, {0.5, 2, false}, {0.5, 0, false}}};

// A step with the resolution of a profile. resolution: factor on width and height, 0: not degraded.
constexpr Quality degraded(Quality step, double resolution) {
  if (resolution <= 0 || resolution >= 1) return step;
  step.scale = std::min(step.scale, resolution);
  step.coarse = true;
  return step;
}

}  // namespace tactus::visual
