// The maps of a scene's materials as touch reads them: relief and friction, from the pictures that the eye gets
// too. They are read before they are felt, in no tick.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <tactus/scene_t.hpp>
#include <vector>

#include "lcmtypes/friction_map.h"
#include "lcmtypes/relief.h"
#include "sync/assets/scene_pictures.h"

namespace tactus::haptic {

// What lies on the surface of one material; null: nothing, or nobody could read it.
struct MaterialMaps {
  std::shared_ptr<const Relief> relief;
  std::shared_ptr<const FrictionMap> friction;
};

struct SurfaceMaps {
  std::vector<MaterialMaps> by_material;
  std::string trouble;  // one sentence on the first that cannot be read; empty: all can

  const MaterialMaps* of(std::int32_t material) const {
    const auto i = static_cast<std::size_t>(material);
    return material >= 0 && i < by_material.size() ? &by_material[i] : nullptr;
  }
};

// Reads them, which may take as long as a second: not for a loop. What cannot be read is smooth.
SurfaceMaps read_maps(const scene_t& scene, const sync::Pictures& pictures);

}  // namespace tactus::haptic
