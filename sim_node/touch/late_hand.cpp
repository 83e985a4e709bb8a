#include "sim_node/touch/late_hand.h"

#include <algorithm>

#include "sync/resampling/sample_status.h"

namespace tactus::sim {

LateHand::LateHand() {
  waiting_.present_on_release();
  waiting_.keep_stamps();
  waiting_.reconstruct_motion();
}

void LateHand::release(sync::HostTime now, sync::SimTime world, const sync::OperatorChain& operators,
                       std::vector<tool_state_t>& out) {
  const sync::DeadbandDef* const deadband = operators.deadband(world);
  const bool coarse = deadband && (deadband->fraction > 0 || deadband->floor > 0 || deadband->adaptive_s_m > 0);
  const bool late = coarse || operators.usual_delay(world) > sync::Nanoseconds(0);
  while (auto next = waiting_.pop(now - operators.presentation_delay(world))) {
    tool_state_t& m = next->first;
    if (newest_.size() >= kMaxTools && !newest_.contains(m.tool)) newest_.clear();
    sync::HostTime& newest = newest_.try_emplace(m.tool, next->second).first->second;
    if (next->second < newest) continue;
    newest = next->second;
    if (late) m.touch_status = std::max(m.touch_status, static_cast<std::int8_t>(sync::SampleStatus::kHeld));
    out.push_back(std::move(m));
  }
}

}  // namespace tactus::sim
