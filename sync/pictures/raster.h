// The pixels of a picture for a surface or the environment.
#pragma once

#include <cstdint>
#include <vector>

namespace tactus::sync {

// 64 MB. Every OpenGL 3.3 device supports 1024; the devices at hand support 16384.
inline constexpr int kMaxRasterSide = 4096;

struct Raster {
  int width = 0, height = 0;
  bool translucent = false;        // it has an opacity below 1
  std::vector<std::uint8_t> rgba;  // as in the file (colours: sRGB), the lowest row first
};

}  // namespace tactus::sync
