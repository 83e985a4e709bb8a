// Requests to the program read_pictures and its answers.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "lcmtypes/height_map.h"
#include "sync/pictures/raster.h"

namespace tactus::sync {

enum class PictureKind : std::uint8_t { kHeightMap, kRaster };

std::vector<std::uint8_t> pack_request(PictureKind kind, std::span<const std::uint8_t> bytes);

std::vector<std::uint8_t> pack(const HeightMap& map);
std::vector<std::uint8_t> pack(const Raster& raster);

// Throw std::runtime_error with one clause when the answer is no picture within the limits: a hostile picture may control its
// reader.
HeightMap unpack_height_map(std::span<const std::uint8_t> answer);
Raster unpack_raster(std::span<const std::uint8_t> answer);

}  // namespace tactus::sync
