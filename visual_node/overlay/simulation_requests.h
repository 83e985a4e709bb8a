// Requests of the window's user to the simulation: pause, step, reset.
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <tactus/sim_command_t.hpp>
#include <tactus/sim_reply_t.hpp>
#include <tactus/world_state_t.hpp>

#include "visual_node/devices/display.h"
#include "visual_node/overlay/keys.h"
#include "visual_node/overlay/picking.h"

namespace tactus::visual {

// A queue of commands to the simulation; each is repeated until it is answered. Pure: messages go in and out.
class SimulationRequests {
 public:
  static constexpr std::size_t kMaxPending = 8;                // more key presses are dropped
  static constexpr sync::Nanoseconds kRepeat{100'000'000};      // a datagram may be lost
  static constexpr sync::Nanoseconds kTimeout{3'000'000'000};  // then sim_node counts as absent

  // The newest world state decides between pause and resume.
  void push(const world_state_t& m) { paused_ = m.clock.rate == 0; }
  // id: a unique number.
  void request(Action action, std::int64_t id);
  void push(const sim_reply_t& m);
  // The command to send now.
  std::optional<sim_command_t> step(sync::HostTime now);
  // The result of the last command; returned once, then empty.
  std::string take_answer() { return std::exchange(answer_, {}); }

 private:
  std::deque<sim_command_t> pending_;
  std::optional<sync::HostTime> first_sent_, sent_;
  std::string answer_;
  bool paused_ = false;
};

}  // namespace tactus::visual
