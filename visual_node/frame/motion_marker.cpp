#include "visual_node/frame/motion_marker.h"

#include <algorithm>

#include "visual_node/frame/marker.h"

namespace tactus::visual {
namespace {

constexpr std::uint64_t kMotionBeginning = 0b0110;

}  // namespace

int marker_height_px(bool events, bool motion) {
  const int rows = motion ? kMarkerRows + kMotionRows : events ? kMarkerRows : 0;
  return rows * kMarkerCell_px;
}

void append_motion_marker(std::vector<Rect>& overlay, std::uint32_t frame, std::span<const PoseSample> samples,
                          int height) {
  const std::size_t rows = std::min<std::size_t>(samples.size(), kMotionRows);
  for (std::size_t i = 0; i < rows; ++i) {
    const std::uint64_t tool = static_cast<std::uint64_t>(samples[i].tool) & 0xf;
    const std::uint64_t sample = static_cast<std::uint64_t>(samples[i].seq) & 0xfffffff;
    const std::uint64_t payload = std::uint64_t{frame & 0xffffff} << 32 | tool << 28 | sample;
    append_row(overlay, encode_row(kMotionBeginning, payload), kMarkerRows + static_cast<int>(i), height);
  }
}

}  // namespace tactus::visual
