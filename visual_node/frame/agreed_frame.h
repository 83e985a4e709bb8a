// A frame as all walls of a room agree on it without a word: from its number alone.
#pragma once

#include <cstdint>
#include <optional>

#include "sync/resampling/body_history.h"
#include "sync/resampling/sample_status.h"
#include "sync/time/time.h"
#include "visual_node/frame/room_time.h"

namespace tactus::visual {

struct AgreedFrame {
  std::int64_t number = 0;
  // Of those before it, how many this wall leaves out.
  std::int64_t skipped = 0;
  RoomTime due;         // when it is to be seen
  sync::HostTime here;  // the same, on the clock of this wall's host
  sync::SimTime world;  // the instant of the world that it shows
  // What happens then has happened so long before it is due.
  sync::Nanoseconds delay{0};
  // Where the head is then, and which sample that was read from: its header.publish_time_ns; -1: none.
  sync::Sample<sync::BodyPose> head;
  std::int64_t head_ns = -1;
  std::int64_t head_seq = 0;  // of that sample
};

}  // namespace tactus::visual
