// Records the outcome of every expected contact event: exactly one report for each. Pure.
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

// Vision must present every begin and every hit.
bool is_expected(const contact_event_t& event);

// The scheduled presentation of an event that happened at `happened`.
using Schedule = std::function<sync::HostTime(std::int64_t event_id, sync::HostTime happened)>;

class EventLedger {
 public:
  // rule: the outcome of an event that could not be shown in time.
  explicit EventLedger(const Settings& settings, sync::LateRule rule = sync::LateRule::kShowNewest)
      : policy_{.rule = rule} {
    set(settings);
  }
  // Without a schedule an event is scheduled at its time plus the delay of the frame.
  void set_schedule(Schedule schedule) { schedule_ = std::move(schedule); }
  // Applies new settings; recorded events stay.
  void set(const Settings& settings);

  // Returns those of the events due for the frame expected at t that must flash. An event that would be shown too
  // late is dropped and reported as such. held: how long a profile has held the picture, so that no earlier frame
  // could show it.
  std::vector<contact_event_t> select_flashes(const std::vector<contact_event_t>& due, const sync::TimeMap& map,
                                              sync::HostTime t, sync::Nanoseconds delay = sync::Nanoseconds(0),
                                              sync::Nanoseconds held = sync::Nanoseconds(0));
  // The frame was presented at t: returns the reports of the events that it showed first, and of those dropped
  // since.
  std::vector<presentation_t> presented(sync::HostTime t);

 private:
  sync::LatePolicy policy_;
  Schedule schedule_;
  sync::Nanoseconds uncertainty_{0};
  std::vector<presentation_t> in_frame_;
  std::vector<presentation_t> dropped_;
};

}  // namespace tactus::visual
