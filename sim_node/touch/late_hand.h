// The stage `action` of a profile: the world receives the messages of a hand late, or not all of them. The felt force is
// rendered from the touch model, which the world still sends at once. A deadband transmits the motion of the hand only: the world
// reconstructs it (sync/degradation/motion_codec.h), and receives all forces. Pure.
#pragma once

#include <cstdint>
#include <map>
#include <tactus/tool_state_t.hpp>
#include <vector>

#include "sync/degradation/degraded_snapshots.h"
#include "sync/time/time.h"

namespace tactus::sim {

class LateHand {
 public:
  LateHand();

  // A message of the sender of its tool (tool_senders.h), in order of arrival. operators: of the stage. decisions: list to which
  // decisions are appended; null: none.
  void push(tool_state_t message, sync::HostTime arrival, sync::OperatorChain& operators, sync::Decisions* decisions) {
    waiting_.push(std::move(message), arrival, operators, decisions);
  }
  // Appends the messages that reach the world by now. world: its simulated time. A message that a newer one of its tool has
  // overtaken is dropped, because impulses are sums and the newest pose counts. While the hand is late or coarse, its touch model reaches
  // as far as one that is rendered late (touch_margin_late), so that fixed surfaces feel the same.
  void release(sync::HostTime now, sync::SimTime world, const sync::OperatorChain& operators, std::vector<tool_state_t>& out);

 private:
  static constexpr std::size_t kMaxTools = 64;  // more come only from corrupt messages

  sync::DegradedSnapshots<tool_state_t> waiting_;
  std::map<std::int32_t, sync::HostTime> newest_;  // arrival of the newest released message, by tool
};

}  // namespace tactus::sim
