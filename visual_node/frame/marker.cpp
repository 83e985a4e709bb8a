#include "visual_node/frame/marker.h"

#include <algorithm>

namespace tactus::visual {
namespace {

constexpr std::uint64_t kBeginning = 0b1010;

}  // namespace

void append_marker(std::vector<Rect>& overlay, std::uint32_t frame, std::span<const std::int64_t> events,
                   int height) {
  const std::size_t rows = std::clamp<std::size_t>(events.size(), 1, kMarkerRows);
  for (std::size_t row = 0; row < rows; ++row) {
    const std::uint64_t event = row < events.size() ? static_cast<std::uint32_t>(events[row]) : 0;
    const std::uint64_t payload = std::uint64_t{frame & 0xffffff} << 32 | event;
    append_row(overlay, encode_row(kBeginning, payload), static_cast<int>(row), height);
  }
}

}  // namespace tactus::visual
