// Look-ahead state, handed from the dynamics to the publisher. Plain data.
#pragma once

#include <functional>
#include <span>
#include <tactus/contact_t.hpp>
#include <vector>

#include "sim_node/model/body_motion.h"
#include "sync/time/time.h"

namespace tactus::sim {

// State of the bodies that are computed ahead.
struct LookAhead {
  sync::SimTime begins{};               // start of the running visual step
  sync::SimTime time{};                 // its end
  std::span<const int> bodies;          // their indices, ascending
  std::span<const BodyMotion> motions;  // of each of `bodies`, at `time`
  // Bodies in neither group until the next step begins; ascending. For these and for `bodies`, StateSource has the
  // state at the start of this step.
  std::span<const int> waiting;
  std::function<void(std::vector<contact_t>&)> contacts;  // of the group AHEAD, at `time`; clears the list first
  bool fresh = false;                                     // the step begins in this tick
  bool held = false;              // the step is late: the bodies stay at rest until it begins
  std::span<const int> promoted;  // bodies that were computed ahead up to this tick
};

}  // namespace tactus::sim
