// What is known of bodies that are computed ahead, as whoever computes hands it to whoever tells. Plain data.
#pragma once

#include <functional>
#include <span>
#include <tactus/contact_t.hpp>
#include <vector>

#include "sim_node/model/body_motion.h"
#include "sync/time/time.h"

namespace tactus::sim {

// Of the bodies that are computed ahead.
struct Ahead {
  sync::SimTime begins{};               // of the visual step that runs
  sync::SimTime time{};                 // its end
  std::span<const int> bodies;          // their numbers, ascending
  std::span<const BodyMotion> motions;  // of each of `bodies`, at `time`
  // In neither group until the next step begins; ascending. As those of `bodies`, StateSource has them as they
  // were when this step began.
  std::span<const int> waiting;
  std::function<void(std::vector<contact_t>&)> contacts;  // of the group AHEAD, at `time`; clears the list first
  bool fresh = false;                                     // the step begins in this tick
  bool held = false;              // the step is late: until it begins they stay where they are
  std::span<const int> promoted;  // that were computed ahead and from this tick on are not
};

}  // namespace tactus::sim
