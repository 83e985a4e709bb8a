#include "visual_node/frame/marker.h"

#include <algorithm>

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

constexpr std::uint64_t kBeginning = 0b1010;

void append_bits(std::vector<bool>& cells, std::uint64_t value, int bits) {
  for (int i = bits - 1; i >= 0; --i) cells.push_back((value >> i) & 1);
}

}  // namespace

std::vector<bool> encode_marker(const Marker& m) {
  const std::uint64_t payload = (std::uint64_t{m.frame & 0xffffff} << 32) | m.event;
  std::vector<bool> cells;
  cells.reserve(kMarkerCells);
  append_bits(cells, kBeginning, 4);
  append_bits(cells, payload, 56);
  append_bits(cells, crc8(payload, 7), 8);
  return cells;
}

std::optional<Marker> decode_marker(const std::vector<bool>& cells) {
  if (cells.size() != kMarkerCells) return std::nullopt;
  const auto bits = [&](int first, int count) {
    std::uint64_t value = 0;
    for (int i = 0; i < count; ++i)
      value = value << 1 | static_cast<std::uint64_t>(cells[static_cast<std::size_t>(first + i)]);
    return value;
  };
  const std::uint64_t payload = bits(4, 56);
  if (bits(0, 4) != kBeginning || bits(60, 8) != crc8(payload, 7)) return std::nullopt;
  return Marker{static_cast<std::uint32_t>(payload >> 32), static_cast<std::uint32_t>(payload)};
}

void append_marker(std::vector<Rect>& overlay, std::uint32_t frame, std::span<const std::int64_t> events,
                   int height) {
  const std::size_t rows = std::clamp<std::size_t>(events.size(), 1, kMarkerRows);
  for (std::size_t row = 0; row < rows; ++row) {
    const auto event = row < events.size() ? static_cast<std::uint32_t>(events[row]) : 0u;
    const auto y = static_cast<float>(height - kMarkerCell_px * (static_cast<int>(row) + 1));
    const float cell = kMarkerCell_px;
    overlay.push_back({0, y, cell * kMarkerCells, cell, 0, 0, 0, 1});
    const std::vector<bool> cells = encode_marker({frame, event});
    for (std::size_t i = 0; i < cells.size(); ++i)
      if (cells[i]) overlay.push_back({cell * static_cast<float>(i), y, cell, cell, 1, 1, 1, 1});
  }
}

std::optional<Marker> read_marker(std::span<const std::uint8_t> luma, int width, int height, int row) {
  const int y = height - kMarkerCell_px * (row + 1);
  if (y < 0 || width < kMarkerCell_px * kMarkerCells) return std::nullopt;
  std::vector<bool> cells;
  for (int i = 0; i < kMarkerCells; ++i) {
    int sum = 0;  // of the inner 2 x 2 pixels, which compression hurts least
    for (const int dy : {1, 2})
      for (const int dx : {1, 2})
        sum += luma[static_cast<std::size_t>((y + dy) * width + kMarkerCell_px * i + dx)];
    cells.push_back(sum > 4 * 127);
  }
  return decode_marker(cells);
}

}  // namespace tactus::visual
