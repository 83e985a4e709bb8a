// Writes a picture as a PNG file.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace tactus::visual {

// rgba: sRGB, the lowest row first; opacity is ignored. Writes atomically: a failure keeps the old file. False when
// the file cannot be written.
bool write_png(const std::string& file, std::span<const std::uint8_t> rgba, int width, int height);

}  // namespace tactus::visual
