// Hits that have come and are no strikes yet. A tick has time for some of them, each of which costs up to 0.3 ms
// (peak.h); the others keep the time that they are due at. Pure.
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
  static constexpr std::size_t kMax = 1024;  // design: half a second of work, and no flood makes it more

  // False when there are too many already: it is not kept.
  bool push(const contact_event_t& event, sync::HostTime scheduled) {
    if (hits_.size() >= kMax) return false;
    hits_.emplace(scheduled, event);
    return true;
  }

  // sound(event, scheduled) for those that are due first, the first of them in any case and then as long as
  // goes_on() says so; drop(event, scheduled) for each that has become so late that the policy drops it.
  template <class GoesOn, class Sound, class Drop>
  void handle(sync::HostTime now, const sync::LatePolicy& late, GoesOn goes_on, Sound sound, Drop drop) {
    for (bool first = true; !hits_.empty();) {
      const auto& [scheduled, event] = *hits_.begin();
      if (late.outcome(now - scheduled) == presentation_t::DROPPED_LATE) {
        drop(event, scheduled);
      } else {
        if (!std::exchange(first, false) && !goes_on()) return;
        sound(event, scheduled);
      }
      hits_.erase(hits_.begin());
    }
  }

  // Of a scene that is over: drop(event, scheduled) for each.
  template <class Drop>
  void clear(Drop drop) {
    for (const auto& [scheduled, event] : hits_) drop(event, scheduled);
    hits_.clear();
  }

  std::size_t size() const { return hits_.size(); }

 private:
  std::multimap<sync::HostTime, contact_event_t> hits_;  // those of one time in the order in which they came
};

}  // namespace tactus::audio
