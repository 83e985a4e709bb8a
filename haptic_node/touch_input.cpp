#include "haptic_node/touch_input.h"

namespace tactus::haptic {

void TouchInput::push(const touch_model_t& model, sync::HostTime arrival) {
  if (model.tool != tool_) return;
  const sync::Follow verdict = simulation_.follow(model.header, model.clock, arrival);
  if (verdict == sync::Follow::kIgnore) return;
  const bool overtaken = newest_ && model.header.sim_time_ns < newest_->header.sim_time_ns;
  if (verdict == sync::Follow::kSame && overtaken) return;
  newest_ = model;
  arrival_ = arrival;
  fresh_ = true;
}

}  // namespace tactus::haptic
