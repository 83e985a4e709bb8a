// Queue of hits that are not yet strikes. A tick processes only some of them, since each costs up to 0.3 ms
// (peak.h); the others keep their scheduled time. Pure.
#pragma once

#include <cstddef>
#include <map>
#include <tactus/contact_event_t.hpp>
#include <tactus/presentation_t.hpp>
#include <utility>

#include "sync/presentation/late.h"
#include "sync/time/time.h"

namespace tactus::audio {

class DueHits {
 public:
  static constexpr std::size_t kMax = 1024;  // design: half a second of work, the upper bound

  // False when the queue is full: the hit is not stored.
  bool push(const contact_event_t& event, sync::HostTime scheduled) {
    if (hits_.size() >= kMax) return false;
    hits_.emplace(scheduled, event);
    return true;
  }

  // Calls sound(event, scheduled) for hits in the order of their time: the first in any case, further ones while
  // has_time() is true. Calls drop(event, scheduled) for each hit that the late policy drops.
  template <class HasTime, class Sound, class Drop>
  void process(sync::HostTime now, const sync::LatePolicy& late, HasTime has_time, Sound sound, Drop drop) {
    for (bool first = true; !hits_.empty();) {
      const auto& [scheduled, event] = *hits_.begin();
      if (late.outcome(now - scheduled) == presentation_t::DROPPED_LATE) {
        drop(event, scheduled);
      } else {
        if (!std::exchange(first, false) && !has_time()) return;
        sound(event, scheduled);
      }
      hits_.erase(hits_.begin());
    }
  }

  // For a scene that has ended: calls drop(event, scheduled) for each.
  template <class Drop>
  void clear(Drop drop) {
    for (const auto& [scheduled, event] : hits_) drop(event, scheduled);
    hits_.clear();
  }

  std::size_t size() const { return hits_.size(); }

 private:
  std::multimap<sync::HostTime, contact_event_t> hits_;  // hits of equal time in their order of arrival
};

}  // namespace tactus::audio
