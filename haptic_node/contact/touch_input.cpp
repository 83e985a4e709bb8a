#include "haptic_node/contact/touch_input.h"

#include <utility>

namespace tactus::haptic {

void TouchInput::push(touch_model_t page, sync::HostTime arrival) {
  if (page.tool != tool_) return;
  const sync::TrackResult result = simulation_.track(page.header, page.clock, arrival);
  if (result == sync::TrackResult::kIgnore) return;
  if (result == sync::TrackResult::kRestart) {
    pages_.clear();
    restarted_ = true;
    new_world_ = new_world_ || newest_;
  }
  const std::int64_t latest_ns = sync::to_ns(simulation_.latest_plausible());
  if (page.header.sim_time_ns > latest_ns) return;
  // A false first model may lie so far ahead that no later one would replace it.
  const bool overtaken =
      newest_ && page.header.sim_time_ns < newest_.header().sim_time_ns && newest_.header().sim_time_ns <= latest_ns;
  if (!restarted_ && overtaken) return;
  const TouchModelView whole = pages_.add(std::move(page));
  if (!whole) {
    if (!unfinished_since_ && !pages_.repeated()) unfinished_since_ = arrival;
    return;
  }
  newest_ = whole;
  arrival_ = arrival;
  unfinished_since_.reset();
  fresh_ = true;
  restarted_ = false;
}

}  // namespace tactus::haptic
