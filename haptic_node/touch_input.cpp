#include "haptic_node/touch_input.h"

namespace tactus::haptic {

void TouchInput::push(const touch_model_t& model, sync::HostTime arrival) {
  if (model.tool != tool_) return;
  if (simulation_.follow(model.header, model.clock, arrival) == sync::Follow::kIgnore) return;
  newest_ = model;
  arrival_ = arrival;
  fresh_ = true;
}

}  // namespace tactus::haptic
