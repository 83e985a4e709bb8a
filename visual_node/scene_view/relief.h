// The relief of a material as light needs it: how steep it is, from its height map.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <string>
#include <tactus/material_def_t.hpp>
#include <vector>

#include "lcmtypes/height_map.h"
#include "sync/scene_exchange.h"

namespace tactus::visual {

using HeightMaps = std::map<std::int64_t, HeightMap>;  // by content hash

// One repetition of a relief.
struct Relief {
  Eigen::Vector2f size_m{1, 1};  // along u and v
  int columns = 0, rows = 0;
  std::vector<Eigen::Vector2f> slopes;  // dh/du, dh/dv, m/m, at the middle of each pixel, the lowest row first
};

// Central differences; the map repeats, so its edges are neighbours.
Relief make_relief(const HeightMap& map, const material_def_t& material);

// Of the scene that the receiver holds. One sentence in `trouble` for each that is not there or damaged.
HeightMaps height_maps_of(const sync::SceneReceiver& scenes, std::vector<std::string>& trouble);

}  // namespace tactus::visual
