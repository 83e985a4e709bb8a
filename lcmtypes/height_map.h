// Height map: heights from a grey picture of 8 or 16 bits, for ground and surface relief. sync/pictures reads it from a PNG.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace tactus {

// Samples per side. The largest is a limit of memory; 2^n + 1 is the usual size of terrain tools.
inline constexpr int kMinHeightMapSide = 2, kMaxHeightMapSide = 4097;

struct HeightMap {
  int columns = 0, rows = 0;
  int white = 255;                    // level of height 1; black is 0
  std::vector<std::uint16_t> levels;  // row-major, the lowest row of the picture first

  // 0 .. 1.
  double at(int column, int row) const {
    return static_cast<double>(levels[static_cast<std::size_t>(row * columns + column)]) / white;
  }
};

}  // namespace tactus
