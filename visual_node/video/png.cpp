#include "visual_node/video/png.h"

#include <png.h>

#include <cstdio>
#include <vector>

namespace tactus::visual {

bool write_png(const std::string& file, std::span<const std::uint8_t> rgba, int width, int height) {
  const auto pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  if (rgba.size() < 4 * pixels) return false;
  std::vector<std::uint8_t> rgb(3 * pixels);
  for (std::size_t i = 0; i < pixels; ++i)
    for (std::size_t c = 0; c < 3; ++c) rgb[3 * i + c] = rgba[4 * i + c];
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(width);
  image.height = static_cast<png_uint_32>(height);
  image.format = PNG_FORMAT_RGB;
  const std::string part_file = file + ".part";
  // A negative stride: the lowest row comes first.
  if (!png_image_write_to_file(&image, part_file.c_str(), 0, rgb.data(), -3 * width, nullptr)) return false;
  return std::rename(part_file.c_str(), file.c_str()) == 0;
}

}  // namespace tactus::visual
