// Arrival of the newest touch model of one tool as it came from the bus, before any operator of a profile: an intended
// delay or gap is not a loss. It follows the same simulation as TouchInput, by the same rules, so that models of other
// tools, of a replaced simulation or of an impossible time do not keep the force alive. Pure.
#pragma once

#include <optional>
#include <tactus/touch_model_t.hpp>

#include "haptic_node/contact/touch_input.h"

namespace tactus::haptic {

class TouchWatchdog {
 public:
  TouchWatchdog(int tool, sync::OwnClock own);

  // A page as it arrived.
  void observe(const touch_model_t& page, sync::HostTime arrival);
  // When the newest complete model arrived; nothing: none yet.
  std::optional<sync::HostTime> arrival() const { return input_.arrival(); }

 private:
  int tool_;
  TouchInput input_;
};

}  // namespace tactus::haptic
