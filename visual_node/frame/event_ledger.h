// Books what becomes of every contact event that vision owes: exactly one report each. Pure.
#pragma once

#include <cstdint>
#include <functional>
#include <tactus/contact_event_t.hpp>
#include <tactus/presentation_t.hpp>
#include <utility>
#include <vector>

#include "sync/presentation/late.h"
#include "sync/time/time.h"
#include "visual_node/settings.gen.h"

namespace tactus::visual {

// Vision owes every begin and every hit.
bool owed(const contact_event_t& event);

// When an event that happened then is to be presented.
using Schedule = std::function<sync::HostTime(std::int64_t event_id, sync::HostTime happened)>;

class EventLedger {
 public:
  // rule: what becomes of an event that could not be shown in time.
  explicit EventLedger(const Settings& settings, sync::Late rule = sync::Late::kShowNewest)
      : policy_{.rule = rule} {
    set(settings);
  }
  // Without one: the delay of the frame after the event.
  void set_schedule(Schedule schedule) { schedule_ = std::move(schedule); }
  // Other settings from now on; what is booked stays.
  void set(const Settings& settings);

  // Of the events due for the frame that is expected to be presented at t: those to flash. An event that would be
  // shown too late is dropped and reported so. held: no frame before could have shown it for so long, on purpose.
  std::vector<contact_event_t> take(const std::vector<contact_event_t>& due, const sync::TimeMap& map,
                                    sync::HostTime t, sync::Nanoseconds delay = sync::Nanoseconds(0),
                                    sync::Nanoseconds held = sync::Nanoseconds(0));
  // The frame was presented at t: reports of the events that it showed first, and of those dropped since.
  std::vector<presentation_t> presented(sync::HostTime t);

 private:
  sync::LatePolicy policy_;
  Schedule schedule_;
  sync::Nanoseconds uncertainty_{0};
  std::vector<presentation_t> in_frame_;
  std::vector<presentation_t> dropped_;
};

}  // namespace tactus::visual
