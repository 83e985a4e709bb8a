// The contact events that are still repeated: each goes out every step until it is 50 ms old, so that no lost datagram
// loses an event. When there are more than fit, those that went out least often come first. Pure.
#pragma once

#include <cstdint>
#include <tactus/contact_event_t.hpp>
#include <vector>

#include "sync/time/time.h"

namespace tactus::sim {

class EventRepeater {
 public:
  static constexpr sync::Nanoseconds kRepeated{50'000'000};
  // A contact_event_t has 81 bytes; so many fit beside the rest of a page.
  static constexpr std::size_t kPerPage = 16;
  // Bounded: in a storm beyond this the oldest give way, after they have been sent.
  static constexpr std::size_t kMax = 4096;

  explicit EventRepeater(std::size_t most_pages) : most_per_step_(most_pages * kPerPage) {}

  // Events that became known in this step. An event counts as young from when it became known: one whose time lies
  // back, as an end does, is repeated as long as any other.
  void add(const std::vector<contact_event_t>& events, sync::SimTime now);
  // Those to send in this step, in order of time.
  const std::vector<contact_event_t>& due(sync::SimTime now);
  std::int64_t overflow() const { return overflow_; }

 private:
  struct Young {
    contact_event_t event;
    sync::SimTime known;
    int sent = 0;
  };
  std::size_t most_per_step_;
  std::vector<Young> young_;
  std::vector<contact_event_t> due_;
  std::int64_t overflow_ = 0;
};

}  // namespace tactus::sim
