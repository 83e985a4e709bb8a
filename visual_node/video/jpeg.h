// A picture as a JPEG file in memory, smaller than it was drawn. Pure.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace tactus::visual {

// rgba: 4 bytes a pixel, the lowest row first. Pixels are averaged, as they are encoded, over what becomes one;
// height keeps the picture's shape. width: at most that of the picture is made of it. quality: 1 .. 100 as libjpeg
// has it. Empty: it could not.
struct Jpeg {
  int width = 0, height = 0;
  std::vector<std::uint8_t> bytes;
};
Jpeg encode_jpeg(std::span<const std::uint8_t> rgba, int picture_width, int picture_height, int width,
                 int quality);

}  // namespace tactus::visual
