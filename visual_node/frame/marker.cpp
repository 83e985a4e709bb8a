#include "visual_node/frame/marker.h"

#include <algorithm>

namespace tactus::visual {
namespace {

constexpr std::uint64_t kBeginning = 0b1010;

}  // namespace

std::vector<bool> encode_marker(const Marker& m) {
  return encode_row(kBeginning, (std::uint64_t{m.frame & 0xffffff} << 32) | m.event);
}

std::optional<Marker> decode_marker(const std::vector<bool>& cells) {
  const auto payload = decode_row(cells, kBeginning);
  if (!payload) return std::nullopt;
  return Marker{static_cast<std::uint32_t>(*payload >> 32), static_cast<std::uint32_t>(*payload)};
}

void append_marker(std::vector<Rect>& overlay, std::uint32_t frame, std::span<const std::int64_t> events,
                   int height) {
  const std::size_t rows = std::clamp<std::size_t>(events.size(), 1, kMarkerRows);
  for (std::size_t row = 0; row < rows; ++row) {
    const auto event = row < events.size() ? static_cast<std::uint32_t>(events[row]) : 0u;
    append_row(overlay, encode_marker({frame, event}), static_cast<int>(row), height);
  }
}

std::optional<Marker> read_marker(std::span<const std::uint8_t> luma, int width, int height, int row) {
  return decode_marker(read_row(luma, width, height, row));
}

}  // namespace tactus::visual
