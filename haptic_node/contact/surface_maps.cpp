#include "haptic_node/contact/surface_maps.h"

#include <map>
#include <stdexcept>
#include <tactus/material_def_t.hpp>
#include <tuple>

#include "sync/pictures/confined_pictures.h"

namespace tactus::haptic {

SurfaceMaps read_maps(const scene_t& scene, const sync::Pictures& pictures) {
  SurfaceMaps maps;
  std::map<std::int64_t, HeightMap> read;
  sync::ConfinedPictures reader;
  const auto map_of = [&](std::int64_t hash, const std::string& material, const char* what) -> const HeightMap* {
    if (hash == 0) return nullptr;
    try {
      const auto known = read.find(hash);
      if (known != read.end()) return &known->second;
      const auto picture = pictures.find(hash);
      if (picture == pictures.end()) throw std::runtime_error("it was not sent");
      return &read.emplace(hash, reader.height_map(picture->second)).first->second;
    } catch (const std::exception& e) {
      if (maps.error.empty())
        maps.error = std::string("the ") + what + " of material " + material + " cannot be read: " + e.what() +
                     "; the surface is rendered without it";
      return nullptr;
    }
  };
  // Materials that inherited a map share it.
  using ReliefKey = std::tuple<std::int64_t, double, double, double>;
  std::map<ReliefKey, std::shared_ptr<const Relief>> reliefs;
  for (const material_def_t& m : scene.materials) {
    MaterialMaps& of = maps.by_material.emplace_back();
    if (const HeightMap* map = map_of(m.bump_asset, m.name, "bump")) {
      auto& relief = reliefs[{m.bump_asset, m.bump_size_u_m, m.bump_size_v_m, m.bump_height_m}];
      if (!relief) relief = std::make_shared<const Relief>(make_relief(*map, m));
      of.relief = relief;
    }
    if (const HeightMap* map = map_of(m.friction_asset, m.name, "friction map"))
      of.friction = std::make_shared<const FrictionMap>(*map, m);
  }
  return maps;
}

}  // namespace tactus::haptic
