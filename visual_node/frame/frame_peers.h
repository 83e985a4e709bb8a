// Tracks the other walls of the room by their messages: which frame each has drawn, and which ones the lock no
// longer waits for. Pure.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <tactus/frame_shown_t.hpp>

#include "sync/time/time.h"

namespace tactus::visual {

class FramePeers {
 public:
  // A wall without a message for this long counts as absent.
  static constexpr sync::Nanoseconds kTimeout{1'000'000'000};
  // A wall with kMaxLateFrames more late frames than frames in time is ignored, until kFramesToReturn frames in a
  // row are in time. Design: a quarter of a second, and half a second, at 60 Hz.
  static constexpr int kMaxLateFrames = 15, kFramesToReturn = 30;
  // More walls than a room has are an error.
  static constexpr std::size_t kMax = 64;

  // own: incarnation of this process, whose own messages are ignored.
  void on_message(const frame_shown_t& m, std::int64_t own, sync::HostTime arrival);
  // True when every wall that is not ignored has drawn that frame, or a later one.
  bool ready(std::int64_t frame, sync::HostTime now) const;
  // That frame is shown now: a wall that has not drawn it was late.
  void shown(std::int64_t frame, sync::HostTime now);
  // Number of present walls, and of those that are ignored.
  int present(sync::HostTime now) const;
  int ignored(sync::HostTime now) const;
  void clear() { walls_.clear(); }

 private:
  struct Wall {
    std::int64_t drawn = -1;
    sync::HostTime last_message{};
    int late = 0;     // counts up to kMaxLateFrames
    int in_time = 0;  // in a row, of an ignored wall
    bool ignored = false;
  };
  std::map<std::int64_t, Wall> walls_;  // by incarnation
};

}  // namespace tactus::visual
