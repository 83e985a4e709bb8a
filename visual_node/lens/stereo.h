// Which parts of the picture show what each eye sees. Pure.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "visual_node/lens/lens.h"

namespace tactus::visual {

// Part of a picture, in shares of its width and height from the lower left, and what is seen in it.
struct View {
  Camera camera;
  float x = 0, y = 0, width = 1, height = 1;
  bool red = true, green = true, blue = true;  // which colours are drawn
};

// As the setting `stereo` says; one view of all where it is off. Left and right halves, or upper and lower, hold
// the whole wall, squeezed: displays for two eyes stretch them. Anaglyph: the left eye sees red, the right one
// green and blue. Quad-buffer: halves too, which the display shows to one eye each.
std::vector<View> views_of(const Lens& lens, const std::optional<Eigen::Isometry3d>& head,
                           const Settings& settings);

}  // namespace tactus::visual
