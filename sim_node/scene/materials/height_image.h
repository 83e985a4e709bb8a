// Reads a grey PNG of 8 or 16 bits as a height map.
#pragma once

#include <filesystem>

#include "sim_node/model/world_def.h"
#include "sync/pictures/confined_pictures.h"

namespace tactus::sim {

// Reads a picture file that fits into an asset. Throws std::runtime_error with one clause.
sync::Bytes read_image_file(const std::filesystem::path& file);

// White is at height size_m.z, black at 0; the top row of the picture is at +y. The picture is decoded in the confined process of
// `pictures`. Throws std::runtime_error with one clause.
Heightfield read_height_image(const std::filesystem::path& file, const Eigen::Vector3d& size_m, const Eigen::Vector3d& centre_m,
                              sync::ConfinedPictures& pictures);

}  // namespace tactus::sim
