// Height map: reads heights from a grey PNG of 8 or 16 bits, for ground and surface relief.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace tactus {

struct HeightMap {
  int columns = 0, rows = 0;
  int white = 255;                    // level of height 1; black is 0
  std::vector<std::uint16_t> levels;  // row-major, the lowest row of the picture first

  // 0 .. 1.
  double at(int column, int row) const {
    return static_cast<double>(levels[static_cast<std::size_t>(row * columns + column)]) / white;
  }
};

// Throws std::runtime_error with one clause when the bytes are another format, damaged, or too many.
HeightMap read_height_map(std::span<const std::uint8_t> png);

}  // namespace tactus
