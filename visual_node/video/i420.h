// Converts a picture to I420 for video encoders: planes of luma and of half-size chroma. Pure.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace tactus::visual {

constexpr std::size_t i420_bytes(int width, int height) {
  return static_cast<std::size_t>(width * height) * 3 / 2;
}

// rgba: the lowest row first, 4 bytes per pixel; out: the highest row first. Width and height are even. Colour matrix
// of ITU-R BT.709 (2015), table 3, in its limited range (Y 16 .. 235), in 8-bit fixed point: error at most 1.5 of
// 255.
void rgba_to_i420(std::span<const std::uint8_t> rgba, int width, int height, std::span<std::uint8_t> out);

}  // namespace tactus::visual
