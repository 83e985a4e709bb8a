#include "visual_node/frame/event_ledger.h"

#include <algorithm>
#include <utility>

namespace tactus::visual {

bool is_expected(const contact_event_t& event) {
  return event.kind == contact_event_t::BEGIN || event.kind == contact_event_t::HIT;
}

void EventLedger::set(const Settings& s) {
  policy_.tolerance = sync::from_seconds(s.late_after_s);
  policy_.drop_after = sync::from_seconds(std::max(s.drop_after_s, s.late_after_s));
  uncertainty_ = sync::from_seconds(s.fence_uncertainty_s);
}

std::vector<contact_event_t> EventLedger::select_flashes(const std::vector<contact_event_t>& due,
                                                         const sync::TimeMap& map, sync::HostTime t,
                                                         sync::Nanoseconds delay, sync::Nanoseconds held) {
  std::vector<contact_event_t> to_flash;
  for (const contact_event_t& event : due) {
    if (!is_expected(event)) continue;
    const sync::HostTime happened = map.to_host(sync::sim_time(event.time_ns));
    const sync::HostTime scheduled = schedule_ ? schedule_(event.event_id, happened) : happened + delay;
    presentation_t r{};
    r.event_id = event.event_id;
    r.part = presentation_t::WHOLE;
    r.scheduled_ns = sync::to_ns(scheduled);
    r.presented_ns = -1;
    r.uncertainty_ns = uncertainty_.count();
    if (policy_.outcome(t - scheduled - held) == presentation_t::DROPPED_LATE) {
      r.outcome = presentation_t::DROPPED_LATE;
      dropped_.push_back(r);
    } else {
      in_frame_.push_back(r);
      to_flash.push_back(event);
    }
  }
  return to_flash;
}

std::vector<presentation_t> EventLedger::presented(sync::HostTime t) {
  std::vector<presentation_t> reports = std::exchange(dropped_, {});
  for (presentation_t& r : in_frame_) {
    r.presented_ns = sync::to_ns(t);
    r.outcome = policy_.outcome(sync::Nanoseconds(r.presented_ns - r.scheduled_ns));
    // The event was predicted to be in time and was shown, so it is late, not dropped.
    if (r.outcome == presentation_t::DROPPED_LATE) r.outcome = presentation_t::LATE;
    reports.push_back(r);
  }
  in_frame_.clear();
  return reports;
}

}  // namespace tactus::visual
