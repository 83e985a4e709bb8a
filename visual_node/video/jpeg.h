// Encodes a picture as a JPEG file in memory, at a reduced size. Pure.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace tactus::visual {

// rgba: 4 bytes per pixel, the lowest row first. Encoded pixels are averaged to the new size; the height keeps the
// aspect ratio. width: limited to that of the picture. quality: 1 .. 100, as in libjpeg. An empty result: encoding
// failed.
struct Jpeg {
  int width = 0, height = 0;
  std::vector<std::uint8_t> bytes;
};
Jpeg encode_jpeg(std::span<const std::uint8_t> rgba, int picture_width, int picture_height, int width,
                 int quality);

}  // namespace tactus::visual
