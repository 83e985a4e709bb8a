// Decodes pictures by libpng and libjpeg, in this process. Only the program read_pictures and tests link these functions; nodes
// use ConfinedPictures, because pictures are untrusted files.
#pragma once

#include <cstdint>
#include <span>

#include "lcmtypes/height_map.h"
#include "sync/pictures/raster.h"

namespace tactus::sync {

// A grey PNG of 8 or 16 bits. Throws std::runtime_error with one clause when the bytes are another format, damaged, or too many.
HeightMap read_height_map(std::span<const std::uint8_t> png);

// PNG or JPEG, at most kMaxRasterSide pixels per side. Throws std::runtime_error with one clause when the bytes are another
// format, damaged, or too large. Takes up to 0.2 s.
Raster read_raster(std::span<const std::uint8_t> bytes);

}  // namespace tactus::sync
