// Repeats contact events: each event is published in every step until it is 50 ms old, so that no lost datagram loses
// an event. When there are more than fit, the events published least often come first. Pure.
#pragma once

#include <cstdint>
#include <tactus/contact_event_t.hpp>
#include <vector>

#include "sync/time/time.h"

namespace tactus::sim {

class EventRepeater {
 public:
  static constexpr sync::Nanoseconds kRepeated{50'000'000};
  // A contact_event_t has 93 bytes; this number fits into a page with its other fields.
  static constexpr std::size_t kPerPage = 14;
  // Upper limit: beyond it, the event published most often is dropped.
  static constexpr std::size_t kMax = 4096;

  explicit EventRepeater(std::size_t max_pages) : max_per_step_(max_pages * kPerPage) {}

  // Events detected in this step. Their age counts from this call, so that an event with an earlier time, such as an
  // end, is repeated as often as any other.
  void add(const std::vector<contact_event_t>& events, sync::SimTime now);
  // The events to publish in this step, ordered by time.
  const std::vector<contact_event_t>& due(sync::SimTime now);
  std::int64_t overflow() const { return overflow_; }

 private:
  struct RepeatedEvent {
    contact_event_t event;
    sync::SimTime added;
    int sent = 0;
  };
  std::size_t max_per_step_;
  std::vector<RepeatedEvent> events_;
  std::vector<contact_event_t> due_;
  std::int64_t overflow_ = 0;
};

}  // namespace tactus::sim
