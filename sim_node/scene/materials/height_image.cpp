#include "sim_node/scene/materials/height_image.h"

#include "sync/assets/scene_receiver.h"
#include "sync/sandbox/regular_file.h"

namespace tactus::sim {

sync::Bytes read_image_file(const std::filesystem::path& file) {
  return sync::read_regular_file(file, sync::SceneReceiver::kMaxAssetBytes);
}

Heightfield read_height_image(const std::filesystem::path& file, const Eigen::Vector3d& size_m, const Eigen::Vector3d& centre_m,
                              sync::ConfinedPictures& pictures) {
  const HeightMap map = pictures.height_map(read_image_file(file));
  Heightfield field;
  field.columns = map.columns, field.rows = map.rows;
  field.size_m = size_m, field.centre_m = centre_m;
  field.heights_m.reserve(map.levels.size());
  for (int row = 0; row < map.rows; ++row)
    for (int column = 0; column < map.columns; ++column) field.heights_m.push_back(map.at(column, row) * size_m.z());
  return field;
}

}  // namespace tactus::sim
