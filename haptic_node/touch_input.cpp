#include "haptic_node/touch_input.h"

namespace tactus::haptic {

void TouchInput::push(const touch_model_t& model, sync::HostTime arrival) {
  if (model.tool != tool_) return;
  const sync::Follow verdict = simulation_.follow(model.header, model.clock, arrival);
  if (verdict == sync::Follow::kIgnore) return;
  const std::int64_t latest_ns = sync::to_ns(simulation_.latest_credible());
  if (model.header.sim_time_ns > latest_ns) return;
  // A false first one may lie so far ahead that nothing would ever replace it.
  const bool overtaken = newest_ && model.header.sim_time_ns < newest_->header.sim_time_ns &&
                         newest_->header.sim_time_ns <= latest_ns;
  if (verdict == sync::Follow::kSame && overtaken) return;
  newest_ = model;
  arrival_ = arrival;
  fresh_ = true;
}

}  // namespace tactus::haptic
