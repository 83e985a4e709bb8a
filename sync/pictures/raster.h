// Decodes a PNG or JPEG picture for a surface or the environment.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace tactus::visual {

struct Raster {
  int width = 0, height = 0;
  bool translucent = false;        // it has an opacity below 1
  std::vector<std::uint8_t> rgba;  // as in the file (colours: sRGB), the lowest row first
};

// PNG or JPEG, at most 4096 pixels per side. Throws std::runtime_error with one clause when the bytes are another
// format, damaged, or too large. Takes up to 0.2 s.
Raster read_raster(std::span<const std::uint8_t> bytes);

}  // namespace tactus::visual
