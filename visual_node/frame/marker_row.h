// One row of marker cells at the lower left edge of a frame, which survives video compression: 4 bits that name the
// kind of row, 56 bits of payload, and their checksum. Pure.
#pragma once

#include <cstdint>
#include <vector>

#include "visual_node/scene_view/draw_list.h"

namespace tactus::visual {

inline constexpr int kMarkerCell_px = 4;
inline constexpr int kMarkerCells = 4 + 56 + 8;

// The cells of one row, true: white. beginning: 4 bits.
std::vector<bool> encode_row(std::uint64_t beginning, std::uint64_t payload);

// Row 0 lies on the lowest 4 pixels, row k above it.
void append_row(std::vector<Rect>& overlay, const std::vector<bool>& cells, int row, int height);

}  // namespace tactus::visual
