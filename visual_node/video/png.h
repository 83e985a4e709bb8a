// Writes a picture as a PNG file.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace tactus::visual {

// rgba: sRGB, the lowest row first; opacity is left out. The file is complete or it is the old one. False when it
// cannot be written.
bool write_png(const std::string& file, std::span<const std::uint8_t> rgba, int width, int height);

}  // namespace tactus::visual
