// How well a picture is drawn: the steps of vision's quality ladder, and the coarseness that a profile asks for.
// Plain data.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

namespace tactus::visual {

struct Quality {
  double scale = 1;  // of width and height at which the scene is drawn, 0 .. 1; it is scaled up to the picture
  int shadow_divisor = 1;  // the shadow map's edge is divided by 1 or 2; 0: no shadows
  bool coarse = false;     // scaled up in blocks and with its flashes; else smoothly, with flashes drawn over it

  bool operator==(const Quality&) const = default;
};

// Each step costs a software renderer clearly less than the one before: tests/bench/visual_node/picture_quality.cpp.
inline constexpr std::array<Quality, 4> kQualities{
    {{1, 1, false}, {0.75, 2, false}, {0.5, 2, false}, {0.5, 0, false}}};

// The step as a profile's resolution leaves it; resolution: factor on width and height, 0: not degraded.
constexpr Quality degraded(Quality step, double resolution) {
  if (resolution <= 0 || resolution >= 1) return step;
  step.scale = std::min(step.scale, resolution);
  step.coarse = true;
  return step;
}

}  // namespace tactus::visual
