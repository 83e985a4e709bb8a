// Decodes the height maps of a scene, from which its reliefs are made (lcmtypes/relief.h).
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <tactus/scene_t.hpp>
#include <vector>

#include "lcmtypes/relief.h"
#include "sync/assets/scene_pictures.h"
#include "sync/pictures/confined_pictures.h"

namespace tactus::visual {

using HeightMaps = std::map<std::int64_t, HeightMap>;  // by content hash

// Decodes them in a confined process. Adds one sentence to `warnings` for each missing or damaged map.
HeightMaps height_maps_of(const scene_t& scene, const sync::Pictures& pictures, sync::ConfinedPictures& reader,
                          std::vector<std::string>& warnings);

}  // namespace tactus::visual
