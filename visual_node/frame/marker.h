// Marker cells at the lower left edge of a frame. They name the frame and the contact events that flash in it, so
// that the frames themselves record what was shown when. scripts/python/tactus/log/marker.py reads them. Pure.
//
// A cell is 4 x 4 pixels, black or white, so that it survives video compression; a row has 68 cells. Row 0 lies on
// the lowest 4 pixels, row k above it. From the left, most significant bit first:
//   1 0 1 0 | frame, 24 bits | low 32 bits of event_id, 0: none | CRC-8 of the seven bytes before
// Row 0 is always there; it names the newest event. The rows above it name the next older events whose flash is
// still visible.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "visual_node/frame/marker_row.h"
#include "visual_node/scene_view/draw_list.h"

namespace tactus::visual {

inline constexpr int kMarkerRows = 12;

// Adds the cells of a whole picture. events: newest first, the first kMarkerRows of them are named.
void append_marker(std::vector<Rect>& overlay, std::uint32_t frame, std::span<const std::int64_t> events,
                   int height);

}  // namespace tactus::visual
