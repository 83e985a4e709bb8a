// A frame that all walls of a room derive from its number alone, without communication.
#pragma once

#include <cstdint>

#include "sync/resampling/body_history.h"
#include "sync/resampling/sample_status.h"
#include "sync/time/time.h"
#include "visual_node/frame/room_time.h"

namespace tactus::visual {

struct LockedFrame {
  std::int64_t number = 0;
  // Number of frames before it that this wall skipped.
  std::int64_t skipped = 0;
  RoomTime due;                  // when it must be visible
  sync::HostTime due_host_time;  // `due` on the clock of this wall's host
  sync::SimTime sim_time;        // shown instant of the world
  // Presentation delay: `due_host_time` minus the host time of `sim_time`.
  sync::Nanoseconds delay{0};
  // The head at the due time, and header.publish_time_ns of the sample that it derives from; -1: none.
  sync::Sample<sync::BodyPose> head;
  std::int64_t head_ns = -1;
  std::int64_t head_seq = 0;  // header.seq of that sample
};

}  // namespace tactus::visual
