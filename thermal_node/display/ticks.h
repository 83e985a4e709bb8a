// Cuts the contact stream into the intervals that one thermal tick after the other integrates: without a gap,
// without an overlap, over pauses and restarts of the simulation. Pure.
#pragma once

#include <optional>
#include <tactus/contact_event_t.hpp>
#include <vector>

#include "sync/resampling/contact_stream.h"
#include "sync/time/time.h"

namespace tactus::thermal {

// What one tick is made from.
struct Tick {
  sync::HostTime begin{}, end{};         // on the host clock: the skin is real and ages in host time
  sync::SimTime sim_begin{}, sim_end{};  // the interval of the world that is felt in it
  sync::ContactIntegral contact;         // over that interval; while the world is paused, the last one holds
  sync::Nanoseconds contact_interval{};  // that `contact` is the mean of
  std::vector<contact_event_t> events;   // that have become due, of all tools
  sync::TimeMap map;                     // from simulated to host time
  sync::Nanoseconds delay{0};            // what is felt happened so long ago, beyond what is still on its way

  double contact_interval_s() const { return sync::to_seconds(contact_interval); }
};

class Ticks {
 public:
  // Contacts of so short ago may still be on their way; heat can wait for them (Fowler et al. 1988: cold takes 0.4
  // s to the brain), so the interval ends that much before now and no part of a touch falls between two ticks.
  static constexpr sync::Nanoseconds kSettle{5'000'000};
  // No tick integrates more than this of the world, however long the process was stopped.
  static constexpr sync::Nanoseconds kLongest{2'000'000'000};

  // now: the clock; newest_arrival: when the newest contact message really came; delay: of presentation. A gap in the
  // stream while messages arrive is commanded: the last contact is held.
  Tick next(sync::ContactStream& stream, sync::HostTime now, sync::HostTime newest_arrival, int tool,
            int tool_body, sync::Nanoseconds delay = sync::Nanoseconds(0));

 private:
  std::optional<sync::HostTime> end_;
  std::optional<sync::SimTime> sim_end_;
  sync::ContactIntegral contact_;
  sync::Nanoseconds contact_interval_{};
  std::int64_t restarts_ = 0;
};

}  // namespace tactus::thermal
