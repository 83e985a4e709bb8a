#include "haptic_node/contact/touch_watchdog.h"

#include <utility>

namespace tactus::haptic {

TouchWatchdog::TouchWatchdog(int tool, sync::OwnClock own) : tool_(tool), input_(tool, own) {}

void TouchWatchdog::observe(const touch_model_t& page, sync::HostTime arrival) {
  if (page.tool != tool_) return;
  touch_model_t head{};  // without planes
  head.header = page.header;
  head.clock = page.clock;
  head.tool = page.tool;
  head.page = page.page;
  head.pages = page.pages;
  input_.push(std::move(head), arrival);
}

}  // namespace tactus::haptic
