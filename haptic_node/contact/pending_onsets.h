// Begin events that still need a report: the time of the first force on their contact, which may be before the
// event arrived. A delayed or thinned touch model is felt later, and is waited for.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <tactus/presentation_t.hpp>
#include <vector>

#include "haptic_node/contact/contact_impulses.h"
#include "sync/time/time.h"

namespace tactus::haptic {

class PendingOnsets {
 public:
  // Begins of a minute, the longest delay of a profile, at 60 a second.
  static constexpr std::size_t kMaxPending = 4096;
  // Time that a contact may stay without force (a graze) in the rendered world before it is reported.
  static constexpr sync::Nanoseconds kMaxWait{100'000'000};
  // Longest wait, beyond kMaxWait and the intended delay, for a touch model that shows the begin: a thinned or frozen
  // stream. The sum must stay below PresentationMatcher::kSettleAfter, or the event would count as lost.
  static constexpr sync::Nanoseconds kMaxModelWait{500'000'000};

  // The world that a tick renders.
  struct Rendered {
    sync::HostTime now{};
    // The instant of the world that the touch model in use shows; nothing: none yet.
    std::optional<sync::HostTime> shown;
    sync::Nanoseconds delay{0};        // intended delay of the touch models
    sync::Nanoseconds uncertainty{0};  // of the time of a force
    // Whether the touch model in use holds the surface of that contact, so that the proxy respects it.
    std::function<bool(std::int64_t contact_id)> surface_known;
  };

  PendingOnsets() { pending_.reserve(kMaxPending); }

  void add(std::int64_t event_id, std::int64_t contact_id, sync::HostTime scheduled, sync::HostTime now,
           std::vector<presentation_t>& reports);
  // Each begin gets exactly one report: PRESENTED at the first force. When the rendered world has passed the begin by kMaxWait
  // without a force: PRESENTED at the tick from which its surface was known, otherwise DROPPED_LATE.
  void step(const Rendered& rendered, const ContactImpulses& impulses, std::vector<presentation_t>& reports);

 private:
  struct PendingBegin {
    std::int64_t event_id, contact_id;
    sync::HostTime scheduled, received;
    std::optional<sync::HostTime> known;  // since when its surface is known
  };
  std::vector<PendingBegin> pending_;
};

}  // namespace tactus::haptic
