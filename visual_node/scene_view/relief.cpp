#include "visual_node/scene_view/relief.h"

#include <algorithm>
#include <set>
#include <stdexcept>

namespace tactus::visual {
namespace {

// 89.4 degrees: a step looks like a wall, and light needs no finer difference.
constexpr double kSteepest = 100;

float slope(double rise) { return static_cast<float>(std::clamp(rise, -kSteepest, kSteepest)); }

}  // namespace

Relief make_relief(const HeightMap& map, const material_def_t& material) {
  Relief relief;
  relief.size_m = Eigen::Vector2d(material.bump_size_u_m, material.bump_size_v_m).cast<float>();
  relief.columns = map.columns, relief.rows = map.rows;
  relief.slopes.reserve(map.levels.size());
  // Height over the two pixels between the neighbours.
  const double along_u = material.bump_height_m * map.columns / (2 * material.bump_size_u_m);
  const double along_v = material.bump_height_m * map.rows / (2 * material.bump_size_v_m);
  for (int row = 0; row < map.rows; ++row) {
    const int above = (row + 1) % map.rows, below = (row + map.rows - 1) % map.rows;
    for (int column = 0; column < map.columns; ++column) {
      const int right = (column + 1) % map.columns, left = (column + map.columns - 1) % map.columns;
      relief.slopes.emplace_back(slope(along_u * (map.at(right, row) - map.at(left, row))),
                                 slope(along_v * (map.at(column, above) - map.at(column, below))));
    }
  }
  return relief;
}

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
