#include "visual_node/lens/stereo.h"

namespace tactus::visual {

std::vector<View> stereo_views(const Lens& lens, const std::optional<Eigen::Isometry3d>& head,
                               const Settings& settings) {
  if (settings.stereo == "off") return {{.camera = lens.camera(head)}};
  const auto [left, right] = lens.eyes(head, settings.eye_distance_m, settings.stereo_distance_m);
  if (settings.stereo == "top_bottom")
    return {{.camera = left, .y = 0.5f, .height = 0.5f}, {.camera = right, .height = 0.5f}};
  if (settings.stereo == "anaglyph")
    return {{.camera = left, .green = false, .blue = false}, {.camera = right, .red = false}};
  return {{.camera = left, .width = 0.5f}, {.camera = right, .x = 0.5f, .width = 0.5f}};
}

}  // namespace tactus::visual
