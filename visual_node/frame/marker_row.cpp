#include "visual_node/frame/marker_row.h"

namespace tactus::visual {
namespace {

// CRC-8 with the polynomial x^8 + x^2 + x + 1 (ITU-T I.432.1, without its final addition).
std::uint8_t crc8(std::uint64_t value, int bytes) {
  std::uint8_t crc = 0;
  for (int i = bytes - 1; i >= 0; --i) {
    crc = static_cast<std::uint8_t>(crc ^ (value >> (8 * i)));
    for (int bit = 0; bit < 8; ++bit) crc = static_cast<std::uint8_t>(crc & 0x80 ? (crc << 1) ^ 0x07 : crc << 1);
  }
  return crc;
}

void append_bits(std::vector<bool>& cells, std::uint64_t value, int bits) {
  for (int i = bits - 1; i >= 0; --i) cells.push_back((value >> i) & 1);
}

}  // namespace

std::vector<bool> encode_row(std::uint64_t beginning, std::uint64_t payload) {
  std::vector<bool> cells;
  cells.reserve(kMarkerCells);
  append_bits(cells, beginning, 4);
  append_bits(cells, payload, 56);
  append_bits(cells, crc8(payload, 7), 8);
  return cells;
}

void append_row(std::vector<Rect>& overlay, const std::vector<bool>& cells, int row, int height) {
  const auto y = static_cast<float>(height - kMarkerCell_px * (row + 1));
  const float cell = kMarkerCell_px;
  overlay.push_back({0, y, cell * kMarkerCells, cell, 0, 0, 0, 1});
  for (std::size_t i = 0; i < cells.size(); ++i)
    if (cells[i]) overlay.push_back({cell * static_cast<float>(i), y, cell, cell, 1, 1, 1, 1});
}

}  // namespace tactus::visual
