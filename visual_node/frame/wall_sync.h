// The part of the frame lock that uses the bus and waits: messages between the walls of a room, and how long a wall
// holds a picture. Every wait is bounded.
#pragma once

#include <functional>
#include <tactus/frame_shown_t.hpp>
#include <tactus/playout_t.hpp>
#include <tactus/tool_state_t.hpp>
#include <tactus/world_state_t.hpp>

#include "sync/node/node.h"
#include "visual_node/frame/frame_lock.h"

namespace tactus::visual {

class WallSync {
 public:
  // Construct before the first tick.
  WallSync(sync::Node& node, FrameLock& lock);

  // Reads the queues: the clock of the simulation, the head, the requested delay, and the frames of other walls.
  void receive();
  // Polls the bus before a frame is begun, and after a stall waits for the missed messages. meanwhile: processes
  // received messages.
  void catch_up(const std::function<void(sync::HostTime)>& meanwhile);
  // Waits after the surfaces are drawn: the flashes are drawn late, so that they show the newest events.
  void wait_for_latch(const LockedFrame& frame) const;
  // Holds a ready picture until it is due, with frame_lock=wait until the others have it too. meanwhile:
  // processes received messages.
  void hold(const LockedFrame& frame, const std::function<void(sync::HostTime)>& meanwhile);
  // Reports that the picture is visible.
  void shown(const LockedFrame& frame) { publish_stage(frame, frame_shown_t::SHOWN); }

 private:
  void publish_stage(const LockedFrame& frame, std::int8_t stage);

  sync::Node& node_;
  FrameLock& lock_;
  sync::Queue<world_state_t>& world_;
  sync::Queue<tool_state_t>& tools_;
  sync::Queue<playout_t>& playouts_;
  sync::Queue<frame_shown_t>& walls_;
  sync::HostTime last_{};  // last catch_up()
};

}  // namespace tactus::visual
