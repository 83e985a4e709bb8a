// Marker cells above those of frame/marker.h. They name the newest pose sample of each tool in the frame, so that
// the latency from motion to pixel can be read from the frames themselves. scripts/python/tactus/log/marker.py reads them. Pure.
//
// A row has the format of frame/marker_row.h, begins with 0 1 1 0 and continues with
//   frame, 24 bits | index of the tool, 4 bits | low 28 bits of header.seq of its TOOL_STATE: three days at 1 kHz
// There are at most kMotionRows rows, on rows kMarkerRows and above, one for each tool with recent messages.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "visual_node/scene_view/draw_list.h"

namespace tactus::visual {

inline constexpr int kMotionRows = 4;

// The report that gave the pose of a tool in a frame.
struct PoseSample {
  int tool = 0;
  std::int64_t seq = 0;
};

// Height of the region at the lower edge of a picture that programs read: nothing is drawn over it.
int marker_height_px(bool events, bool motion);

void append_motion_marker(std::vector<Rect>& overlay, std::uint32_t frame, std::span<const PoseSample> samples,
                          int height);

}  // namespace tactus::visual
