// What walls of a room say to each other, and how long one holds a picture: the part of the frame lock that is on
// the bus and that waits. Every wait is bounded.
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
  // Make it before the first tick.
  WallSync(sync::Node& node, FrameLock& lock);

  // What has arrived: the clock of the simulation, the head, the delay that is asked for, and what other walls
  // have drawn.
  void receive();
  // Before a frame is begun, `meanwhile` takes in what arrives: also what a loop that was held up has missed.
  void catch_up(const std::function<void(sync::HostTime)>& meanwhile);
  // A picture's surfaces are drawn: its flashes come late, so that they show what has just happened.
  void wait_for_latch(const AgreedFrame& frame) const;
  // A picture is ready: holds it until it is due, with frame_lock=wait until the others have it too. meanwhile:
  // takes in what arrives.
  void hold(const AgreedFrame& frame, const std::function<void(sync::HostTime)>& meanwhile);
  // It is seen.
  void shown(const AgreedFrame& frame) { tell(frame, frame_shown_t::SHOWN); }

 private:
  void tell(const AgreedFrame& frame, std::int8_t stage);

  sync::Node& node_;
  FrameLock& lock_;
  sync::Queue<world_state_t>& world_;
  sync::Queue<tool_state_t>& tools_;
  sync::Queue<playout_t>& playouts_;
  sync::Queue<frame_shown_t>& walls_;
  sync::HostTime last_{};  // caught up
};

}  // namespace tactus::visual
