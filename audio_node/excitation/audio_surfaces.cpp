#include "audio_node/excitation/audio_surfaces.h"

#include <map>
#include <stdexcept>
#include <tactus/material_def_t.hpp>
#include <tuple>

#include "sync/pictures/confined_pictures.h"

namespace tactus::audio {

std::unique_ptr<AudioSurfaces> load_surfaces(const scene_t& scene, const sync::Pictures& pictures) {
  std::map<std::int64_t, HeightMap> maps;
  sync::ConfinedPictures reader;
  for (const auto& [hash, bytes] : pictures) try {
      maps.emplace(hash, reader.height_map(bytes));
    } catch (const std::runtime_error&) {  // vision and touch report the reason
    }
  auto surfaces = std::make_unique<AudioSurfaces>();
  // Materials that inherited a map share it.
  std::map<std::tuple<std::int64_t, double, double, double>, std::shared_ptr<const ReliefLevels>> reliefs;
  for (const material_def_t& m : scene.materials) {
    AudioSurface& of = surfaces->by_material.emplace_back();
    if (const auto map = maps.find(m.bump_asset); map != maps.end()) {
      auto& relief = reliefs[{m.bump_asset, m.bump_size_u_m, m.bump_size_v_m, m.bump_height_m}];
      if (!relief) relief = std::make_shared<const ReliefLevels>(make_relief(map->second, m));
      of.relief = relief;
    }
    if (const auto map = maps.find(m.friction_asset); map != maps.end())
      of.friction = std::make_shared<const FrictionMap>(map->second, m);
  }
  return surfaces;
}

}  // namespace tactus::audio
