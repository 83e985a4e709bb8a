// Strikes the hits of an event inbox that are due. A tick processes only some of them, since each costs up to 0.3 ms (peak.h);
// the others stay in the inbox. Pure.
#pragma once

#include <tactus/contact_event_t.hpp>
#include <tactus/presentation_t.hpp>
#include <utility>

#include "sync/presentation/late.h"
#include "sync/resampling/event_inbox.h"
#include "sync/time/time.h"

namespace tactus::audio {

// The functions of the renderer that strike_due_hits calls.
template <class Schedule, class HasTime, class Strike, class Drop>
struct HitActions {
  Schedule schedule;  // HostTime(event): when it is to be heard
  HasTime has_time;   // bool(): the tick has time for another strike
  Strike strike;      // void(event, scheduled)
  Drop drop;          // void(event, scheduled): the policy drops it because it is overdue
};

// Takes the events before `until`, in order of time: strikes the first hit in any case and further ones while the tick has
// time; drops overdue ones. Returns the number of hits that were taken.
template <class Schedule, class HasTime, class Strike, class Drop>
int strike_due_hits(sync::EventInbox& events, sync::SimTime until, sync::HostTime now, const sync::LatePolicy& late,
                    const HitActions<Schedule, HasTime, Strike, Drop>& actions) {
  int hits = 0;
  for (bool first = true; const contact_event_t* event = events.front(until); events.pop_front()) {
    if (event->kind != contact_event_t::HIT) continue;
    const sync::HostTime scheduled = actions.schedule(*event);
    const bool overdue = late.outcome(now - scheduled) == presentation_t::DROPPED_LATE;
    if (!overdue && !std::exchange(first, false) && !actions.has_time()) return hits;
    overdue ? actions.drop(*event, scheduled) : actions.strike(*event, scheduled);
    ++hits;
  }
  return hits;
}

}  // namespace tactus::audio
