// What a person at the window asks for: overlays at once, the simulation over the bus (never waiting for its
// answer), the lamp by the mouse.
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <tactus/sim_command_t.hpp>
#include <tactus/sim_reply_t.hpp>
#include <tactus/world_state_t.hpp>

#include "visual_node/devices/display.h"
#include "visual_node/overlay/aim.h"
#include "visual_node/overlay/keys.h"

namespace tactus::visual {

// Commands to the simulation, one after the other, each repeated until it is answered. Pure: messages go in and
// out.
class SimulationWishes {
 public:
  static constexpr std::size_t kMaxWaiting = 8;                // more keys than that are not kept
  static constexpr sync::Nanoseconds kRepeat{100'000'000};      // a datagram may be lost
  static constexpr sync::Nanoseconds kPatience{3'000'000'000};  // then nobody is there

  // The world as last heard of tells whether to pause or to resume.
  void push(const world_state_t& m) { paused_ = m.clock.rate == 0; }
  // id: a number that no other question has.
  void ask(Act act, std::int64_t id);
  void push(const sim_reply_t& m);
  // What is to be sent now.
  std::optional<sim_command_t> step(sync::HostTime now);
  // What became of the last; told once, then empty.
  std::string take_answer() { return std::exchange(answer_, {}); }

 private:
  std::deque<sim_command_t> waiting_;
  std::optional<sync::HostTime> asked_, sent_;
  std::string answer_;
  bool paused_ = false;
};

}  // namespace tactus::visual
