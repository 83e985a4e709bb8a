// Relief and friction maps of the materials of a scene, from the pictures that are also displayed. They are read
// in the background, never in a tick.
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

// Maps of one material; null: none, or not readable.
struct MaterialMaps {
  std::shared_ptr<const Relief> relief;
  std::shared_ptr<const FrictionMap> friction;
};

struct SurfaceMaps {
  std::vector<MaterialMaps> by_material;
  std::string error;  // one sentence on the first map that cannot be read; empty: all were read

  const MaterialMaps* find(std::int32_t material) const {
    const auto i = static_cast<std::size_t>(material);
    return material >= 0 && i < by_material.size() ? &by_material[i] : nullptr;
  }
};

// Reads the maps. It may take a second, so do not call it in a loop. Materials whose map cannot be read are
// smooth.
SurfaceMaps read_maps(const scene_t& scene, const sync::Pictures& pictures);

}  // namespace tactus::haptic
