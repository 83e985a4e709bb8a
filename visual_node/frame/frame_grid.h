// Due times of frames: frame k is due at k periods of the room's clock, on every wall. Pure.
#pragma once

#include <cstdint>
#include <optional>

#include "visual_node/frame/room_time.h"

namespace tactus::visual {

class FrameGrid {
 public:
  // A frame this far before the last one means that the clock was put back, or is another clock.
  static constexpr std::int64_t kMaxFramesBack = 3;

  explicit FrameGrid(double rate_Hz = 60) : period_ns_(1e9 / rate_Hz) {}

  RoomTime due(std::int64_t frame) const;
  std::int64_t first_due_at_or_after(RoomTime t) const;
  sync::Nanoseconds period() const { return sync::Nanoseconds(static_cast<std::int64_t>(period_ns_)); }

  // The first frame that is due at `ready` (the earliest time at which its picture can be seen) or later, and
  // that comes after the last picked frame.
  std::int64_t next(RoomTime ready) const;
  std::int64_t select_next(RoomTime ready) { return *(last_ = next(ready)); }
  std::optional<std::int64_t> last() const { return last_; }
  void restart() { last_.reset(); }

 private:
  double period_ns_;
  std::optional<std::int64_t> last_;
};

}  // namespace tactus::visual
