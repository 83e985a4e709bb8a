// The clock of a room: CLOCK_MONOTONIC of sim_node's host. It has its own type, so that it cannot be mixed with the
// clock of the wall's host.
#pragma once

#include <chrono>
#include <cstdint>

#include "sync/time/time.h"

namespace tactus::visual {

struct RoomClock {
  using duration = sync::Nanoseconds;
  using rep = duration::rep;
  using period = duration::period;
  using time_point = std::chrono::time_point<RoomClock, sync::Nanoseconds>;
  static constexpr bool is_steady = true;
};

using RoomTime = RoomClock::time_point;

constexpr RoomTime room_time(std::int64_t ns) { return RoomTime(sync::Nanoseconds(ns)); }

}  // namespace tactus::visual
