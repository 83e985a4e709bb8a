#include "sim_node/publish/event_repeater.h"

#include <algorithm>

namespace tactus::sim {

void EventRepeater::add(const std::vector<contact_event_t>& events, sync::SimTime now) {
  for (const contact_event_t& e : events) {
    if (events_.size() >= kMax) {
      const auto max_sent = std::max_element(events_.begin(), events_.end(),
                                              [](const RepeatedEvent& a, const RepeatedEvent& b) { return a.sent < b.sent; });
      if (max_sent->sent == 0) ++overflow_;
      events_.erase(max_sent);
    }
    events_.push_back({e, now, 0});
  }
}

const std::vector<contact_event_t>& EventRepeater::due(sync::SimTime now) {
  std::erase_if(events_, [now](const RepeatedEvent& y) { return now - y.added >= kRepeated && y.sent > 0; });
  if (events_.size() > max_per_step_)
    std::stable_sort(events_.begin(), events_.end(), [](const RepeatedEvent& a, const RepeatedEvent& b) { return a.sent < b.sent; });
  due_.clear();
  for (std::size_t i = 0; i < std::min(events_.size(), max_per_step_); ++i) {
    due_.push_back(events_[i].event);
    ++events_[i].sent;
  }
  std::stable_sort(due_.begin(), due_.end(),
                   [](const contact_event_t& a, const contact_event_t& b) { return a.time_ns < b.time_ns; });
  return due_;
}

}  // namespace tactus::sim
