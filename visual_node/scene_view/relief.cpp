#include "visual_node/scene_view/relief.h"

#include <set>
#include <stdexcept>

namespace tactus::visual {
HeightMaps height_maps_of(const sync::SceneReceiver& scenes, std::vector<std::string>& trouble) {
  HeightMaps maps;
  if (!scenes.scene()) return maps;
  std::set<std::int64_t> tried{0};  // 0: smooth
  for (const material_def_t& material : scenes.scene()->materials) {
    if (!tried.insert(material.bump_asset).second) continue;
    const sync::Asset* asset = scenes.asset(material.bump_asset);
    try {
      if (!asset) throw std::runtime_error("it was not sent");
      maps.emplace(material.bump_asset, read_height_map(asset->bytes));
    } catch (const std::exception& e) {
      trouble.push_back("the bump of material " + material.name + " cannot be read: " + e.what() +
                        "; it is drawn smooth");
    }
  }
  return maps;
}

}  // namespace tactus::visual
