// Reads the marker cells of a picture (visual_node/frame/marker.h, motion_marker.h) from its luma: rows from the
// top, one byte per pixel. Shares no code with the encoder.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "visual_node/frame/marker.h"
#include "visual_node/frame/motion_marker.h"

namespace tactus::test {

struct Marker {
  std::uint32_t frame = 0;  // modulo 2^24
  std::uint32_t event = 0;  // low 32 bits of event_id
};

struct MotionMarker {
  std::uint32_t frame = 0;   // modulo 2^24
  int tool = 0;              // modulo 2^4
  std::uint32_t sample = 0;  // modulo 2^28
};

// Row 0 lies on the lowest 4 pixels, row k above it. True: white. Empty: the picture has no such row.
inline std::vector<bool> read_cells(std::span<const std::uint8_t> luma, int width, int height, int row) {
  using visual::kMarkerCell_px, visual::kMarkerCells;
  const int y = height - kMarkerCell_px * (row + 1);
  std::vector<bool> cells;
  if (y < 0 || width < kMarkerCell_px * kMarkerCells) return cells;
  for (int i = 0; i < kMarkerCells; ++i) {
    int sum = 0;  // of the inner 2 x 2 pixels, which compression changes least
    for (const int dy : {1, 2})
      for (const int dx : {1, 2})
        sum += luma[static_cast<std::size_t>((y + dy) * width + kMarkerCell_px * i + dx)];
    cells.push_back(sum > 4 * 127);
  }
  return cells;
}

// The 56 bits of payload; nothing when the first 4 bits or the checksum are wrong.
inline std::optional<std::uint64_t> decode_cells(const std::vector<bool>& cells, unsigned beginning) {
  if (cells.size() != visual::kMarkerCells) return std::nullopt;
  unsigned first = 0, remainder = 0;  // of the division of payload and checksum by x^8 + x^2 + x + 1
  std::uint64_t payload = 0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const unsigned bit = cells[i];
    if (i < 4) {
      first = first << 1 | bit;
      continue;
    }
    if (i < 60) payload = payload << 1 | bit;
    remainder = remainder << 1 | bit;
    if (remainder & 0x100) remainder ^= 0x107;
  }
  if (first != beginning || remainder != 0) return std::nullopt;
  return payload;
}

inline std::optional<Marker> decode_marker(const std::vector<bool>& cells) {
  const auto payload = decode_cells(cells, 0b1010);
  if (!payload) return std::nullopt;
  return Marker{static_cast<std::uint32_t>(*payload >> 32), static_cast<std::uint32_t>(*payload)};
}

inline std::optional<Marker> read_marker(std::span<const std::uint8_t> luma, int width, int height, int row) {
  return decode_marker(read_cells(luma, width, height, row));
}

// row: 0 .. kMotionRows - 1.
inline std::optional<MotionMarker> read_motion_marker(std::span<const std::uint8_t> luma, int width, int height,
                                                      int row) {
  const auto payload = decode_cells(read_cells(luma, width, height, visual::kMarkerRows + row), 0b0110);
  if (!payload) return std::nullopt;
  return MotionMarker{static_cast<std::uint32_t>(*payload >> 32), static_cast<int>(*payload >> 28 & 0xf),
                      static_cast<std::uint32_t>(*payload & 0xfffffff)};
}

}  // namespace tactus::test
