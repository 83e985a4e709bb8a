#include "visual_node/scene_view/relief.h"

#include <set>
#include <stdexcept>
#include <tactus/material_def_t.hpp>

namespace tactus::visual {

HeightMaps height_maps_of(const scene_t& scene, const sync::Pictures& pictures, sync::ConfinedPictures& reader,
                          std::vector<std::string>& warnings) {
  HeightMaps maps;
  std::set<std::int64_t> tried{0};  // 0: smooth
  for (const material_def_t& material : scene.materials) {
    if (!tried.insert(material.bump_asset).second) continue;
    const auto picture = pictures.find(material.bump_asset);
    try {
      if (picture == pictures.end()) throw std::runtime_error("it was not sent");
      maps.emplace(material.bump_asset, reader.height_map(picture->second));
    } catch (const std::exception& e) {
      warnings.push_back("the height map of material " + material.name + " cannot be read: " + e.what() +
                         "; it is drawn smooth");
    }
  }
  return maps;
}

}  // namespace tactus::visual
