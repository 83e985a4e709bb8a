// Size and centre of the bounding box of a mesh. Pure.
#pragma once

#include <algorithm>
#include <limits>
#include <optional>
#include <tactus/mesh_t.hpp>

#include "audio_node/modal/body_sound.h"

namespace tactus::audio {

inline std::optional<Extent> extent_of(const mesh_t& mesh) {
  if (mesh.positions_m.size() < 3) return std::nullopt;
  double low[3], high[3];
  std::fill(low, low + 3, std::numeric_limits<double>::max());
  std::fill(high, high + 3, std::numeric_limits<double>::lowest());
  for (std::size_t i = 0; i + 2 < mesh.positions_m.size(); i += 3)
    for (std::size_t k = 0; k < 3; ++k) {
      low[k] = std::min<double>(low[k], mesh.positions_m[i + k]);
      high[k] = std::max<double>(high[k], mesh.positions_m[i + k]);
    }
  return Extent{high[0] - low[0],
                high[1] - low[1],
                high[2] - low[2],
                {(low[0] + high[0]) / 2, (low[1] + high[1]) / 2, (low[2] + high[2]) / 2}};
}

}  // namespace tactus::audio
