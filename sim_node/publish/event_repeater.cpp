#include "sim_node/publish/event_repeater.h"

#include <algorithm>

namespace tactus::sim {

void EventRepeater::add(const std::vector<contact_event_t>& events, sync::SimTime now) {
  for (const contact_event_t& e : events) {
    if (young_.size() >= kMax) {
      const auto most_sent = std::max_element(young_.begin(), young_.end(),
                                              [](const Young& a, const Young& b) { return a.sent < b.sent; });
      if (most_sent->sent == 0) ++overflow_;
      young_.erase(most_sent);
    }
    young_.push_back({e, now, 0});
  }
}

const std::vector<contact_event_t>& EventRepeater::due(sync::SimTime now) {
  std::erase_if(young_, [now](const Young& y) { return now - y.known >= kRepeated && y.sent > 0; });
  if (young_.size() > most_per_step_)
    std::stable_sort(young_.begin(), young_.end(), [](const Young& a, const Young& b) { return a.sent < b.sent; });
  due_.clear();
  for (std::size_t i = 0; i < std::min(young_.size(), most_per_step_); ++i) {
    due_.push_back(young_[i].event);
    ++young_[i].sent;
  }
  std::stable_sort(due_.begin(), due_.end(),
                   [](const contact_event_t& a, const contact_event_t& b) { return a.time_ns < b.time_ns; });
  return due_;
}

}  // namespace tactus::sim
