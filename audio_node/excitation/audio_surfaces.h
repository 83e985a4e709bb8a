// Reliefs and friction maps of the surfaces of a scene for audio, from the pictures that touch and vision use too.
// Pure.
#pragma once

#include <cstdint>
#include <memory>
#include <tactus/scene_t.hpp>
#include <vector>

#include "audio_node/excitation/relief_levels.h"
#include "lcmtypes/friction_map.h"
#include "sync/assets/scene_pictures.h"

namespace tactus::audio {

// The maps of one material; null: there is none, or it cannot be read.
struct AudioSurface {
  std::shared_ptr<const ReliefLevels> relief;
  std::shared_ptr<const FrictionMap> friction;
  bool has_maps() const { return relief || friction; }
};

struct AudioSurfaces {
  std::vector<AudioSurface> by_material;

  const AudioSurface* of(std::int32_t material) const {
    const auto i = static_cast<std::size_t>(material);
    return material >= 0 && i < by_material.size() && by_material[i].has_maps() ? &by_material[i] : nullptr;
  }
};

// Reads the maps and makes their tables. It may take a second, so do not call it in a loop. Surfaces with
// unreadable maps are smooth.
std::unique_ptr<AudioSurfaces> load_surfaces(const scene_t& scene, const sync::Pictures& pictures);

}  // namespace tactus::audio
