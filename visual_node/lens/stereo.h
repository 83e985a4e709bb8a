// The views of a stereo picture: one part of the picture for each eye. Pure.
#pragma once

#include <optional>
#include <vector>

#include "visual_node/lens/lens.h"

namespace tactus::visual {

// A part of a picture, in shares of its width and height from the lower left, and its camera.
struct View {
  Camera camera;
  float x = 0, y = 0, width = 1, height = 1;
  bool red = true, green = true, blue = true;  // colour channels that are drawn
};

// The views for the setting `stereo`; one full view when it is off. Each half (left and right, or upper and lower)
// holds the whole wall, squeezed: stereo displays stretch it. Anaglyph: red for the left eye, green and blue for
// the right one. Quad-buffer: also halves, which the display shows to one eye each.
std::vector<View> stereo_views(const Lens& lens, const std::optional<Eigen::Isometry3d>& head,
                               const Settings& settings);

}  // namespace tactus::visual
