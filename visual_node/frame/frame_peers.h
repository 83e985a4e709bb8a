// The other walls of the room as they are heard: whether each has drawn a frame, and which of them are not waited
// for. Pure.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <tactus/frame_shown_t.hpp>

#include "sync/time/time.h"

namespace tactus::visual {

class FramePeers {
 public:
  // A wall that was not heard of for so long is not there.
  static constexpr sync::Nanoseconds kGone{1'000'000'000};
  // A wall whose frames are too late so many times more often than not is not waited for, until so many in a row
  // are in time. design: a quarter of a second, and half a second, at 60 Hz
  static constexpr int kGiveUp = 15, kReturn = 30;
  // More walls than a room has are a mistake.
  static constexpr std::size_t kMax = 64;

  // own: incarnation of this process, whose messages come back to it.
  void hear(const frame_shown_t& m, std::int64_t own, sync::HostTime arrival);
  // Every wall that is waited for has drawn that frame, or a later one.
  bool ready(std::int64_t frame, sync::HostTime now) const;
  // That frame is shown now: who has not drawn it was too late.
  void shown(std::int64_t frame, sync::HostTime now);
  // Walls that are there, and of those the ones that are not waited for.
  int present(sync::HostTime now) const;
  int not_waited_for(sync::HostTime now) const;
  void forget() { walls_.clear(); }

 private:
  struct Wall {
    std::int64_t drawn = -1;
    sync::HostTime heard{};
    int late = 0;     // towards kGiveUp
    int in_time = 0;  // in a row, of one that was given up
    bool given_up = false;
  };
  std::map<std::int64_t, Wall> walls_;  // by incarnation
};

}  // namespace tactus::visual
