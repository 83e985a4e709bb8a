// Begin events that still need a report: the time of the first force on their contact, which may be before the
// event arrived.
#pragma once

#include <cstdint>
#include <tactus/presentation_t.hpp>
#include <vector>

#include "haptic_node/contact/contact_impulses.h"
#include "sync/time/time.h"

namespace tactus::haptic {

class PendingOnsets {
 public:
  static constexpr std::size_t kMaxWaiting = 64;
  // Time that a contact may stay without force (a graze) before it is reported.
  static constexpr sync::Nanoseconds kPatience{100'000'000};

  PendingOnsets() { waiting_.reserve(kMaxWaiting); }

  // surface_known: the touch model holds the surface of that contact, so the proxy already respects it.
  void add(std::int64_t event_id, std::int64_t contact_id, sync::HostTime scheduled, sync::HostTime now,
           bool surface_known, std::vector<presentation_t>& reports);
  // Each begin gets exactly one report: PRESENTED at the first force. After kPatience: PRESENTED at the tick that
  // received it if its surface was known then, otherwise DROPPED_LATE.
  void step(sync::HostTime now, const ContactImpulses& book, sync::Nanoseconds uncertainty,
            std::vector<presentation_t>& reports);

 private:
  struct Waiting {
    std::int64_t event_id, contact_id;
    sync::HostTime scheduled, taken;
    bool surface_known;
  };
  std::vector<Waiting> waiting_;
};

}  // namespace tactus::haptic
