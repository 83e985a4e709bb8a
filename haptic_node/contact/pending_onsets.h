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
  static constexpr std::size_t kMaxPending = 64;
  // Time that a contact may stay without force (a graze) before it is reported.
  static constexpr sync::Nanoseconds kMaxWait{100'000'000};

  PendingOnsets() { pending_.reserve(kMaxPending); }

  // surface_known: the touch model holds the surface of that contact, so the proxy already respects it.
  void add(std::int64_t event_id, std::int64_t contact_id, sync::HostTime scheduled, sync::HostTime now,
           bool surface_known, std::vector<presentation_t>& reports);
  // Each begin gets exactly one report: PRESENTED at the first force. After kMaxWait: PRESENTED at the tick that
  // received it if its surface was known then, otherwise DROPPED_LATE.
  void step(sync::HostTime now, const ContactImpulses& impulses, sync::Nanoseconds uncertainty,
            std::vector<presentation_t>& reports);

 private:
  struct PendingBegin {
    std::int64_t event_id, contact_id;
    sync::HostTime scheduled, received;
    bool surface_known;
  };
  std::vector<PendingBegin> pending_;
};

}  // namespace tactus::haptic
