// What lies on the surfaces of a scene as it is heard of what slides over them: reliefs and friction maps, from
// the pictures that hand and eye get too. Pure.
#pragma once

#include <cstdint>
#include <memory>
#include <tactus/scene_t.hpp>
#include <vector>

#include "audio_node/excitation/relief_levels.h"
#include "lcmtypes/friction_map.h"
#include "sync/assets/scene_pictures.h"

namespace tactus::audio {

// Of one material; null: nothing, or nobody could read it.
struct HeardSurface {
  std::shared_ptr<const ReliefLevels> relief;
  std::shared_ptr<const FrictionMap> friction;
  bool heard() const { return relief || friction; }
};

struct HeardSurfaces {
  std::vector<HeardSurface> by_material;

  const HeardSurface* of(std::int32_t material) const {
    const auto i = static_cast<std::size_t>(material);
    return material >= 0 && i < by_material.size() && by_material[i].heard() ? &by_material[i] : nullptr;
  }
};

// Reads them and makes their tables, which may take as long as a second: not for a loop. What cannot be read is
// smooth.
std::unique_ptr<HeardSurfaces> read_surfaces(const scene_t& scene, const sync::Pictures& pictures);

}  // namespace tactus::audio
