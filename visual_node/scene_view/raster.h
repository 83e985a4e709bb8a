// A picture for a surface or for what lies around the scene, from the bytes of a file.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace tactus::visual {

struct Raster {
  int width = 0, height = 0;
  bool translucent = false;        // an opacity below 1 is in it
  std::vector<std::uint8_t> rgba;  // as in the file (colours: sRGB), the lowest row first
};

// PNG or JPEG, at most 4096 pixels a side. Throws std::runtime_error with one clause when the bytes are no such
// picture, are damaged, or are too many. Takes as long as 0.2 s.
Raster read_raster(std::span<const std::uint8_t> bytes);

}  // namespace tactus::visual
