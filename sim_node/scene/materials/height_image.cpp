#include "sim_node/scene/materials/height_image.h"

#include <fstream>
#include <stdexcept>

#include "lcmtypes/height_map.h"
#include "sync/assets/scene_receiver.h"

namespace tactus::sim {

sync::Bytes read_image_file(const std::filesystem::path& file) {
  if (std::filesystem::file_size(file) > sync::SceneReceiver::kMaxAssetBytes)
    throw std::runtime_error("it is larger than " + std::to_string(sync::SceneReceiver::kMaxAssetBytes >> 20) + " MiB");
  std::ifstream in(file, std::ios::binary);
  sync::Bytes bytes{std::istreambuf_iterator<char>(in), {}};
  if (!in) throw std::runtime_error("it is not readable");
  return bytes;
}

Heightfield read_height_image(const std::filesystem::path& file, const Eigen::Vector3d& size_m,
                              const Eigen::Vector3d& centre_m) {
  const HeightMap map = read_height_map(read_image_file(file));
  Heightfield field;
  field.columns = map.columns, field.rows = map.rows;
  field.size_m = size_m, field.centre_m = centre_m;
  field.heights_m.reserve(map.levels.size());
  for (int row = 0; row < map.rows; ++row)
    for (int column = 0; column < map.columns; ++column) field.heights_m.push_back(map.at(column, row) * size_m.z());
  return field;
}

}  // namespace tactus::sim
