#include "visual_node/frame/frame_grid.h"

#include <cmath>

namespace tactus::visual {

// Computed in double, equal on every host; exact to 1 ns for the first hundred days of a clock.
RoomTime FrameGrid::due(std::int64_t frame) const {
  return room_time(std::llround(static_cast<double>(frame) * period_ns_));
}

std::int64_t FrameGrid::first_due_at_or_after(RoomTime t) const {
  auto frame = static_cast<std::int64_t>(std::ceil(static_cast<double>(sync::to_ns(t)) / period_ns_));
  // The division may be off by one where t is exactly due.
  while (due(frame - 1) >= t) --frame;
  while (due(frame) < t) ++frame;
  return frame;
}

std::int64_t FrameGrid::next(RoomTime ready) const {
  const std::int64_t first = first_due_at_or_after(ready);
  return last_ && first <= *last_ && *last_ - first < kMaxFramesBack ? *last_ + 1 : first;
}

}  // namespace tactus::visual
