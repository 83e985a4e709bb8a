// Divides the contact stream into the intervals that successive thermal ticks integrate, without gap or overlap,
// across pauses and restarts of the simulation. Pure.
#pragma once

#include <optional>
#include <tactus/contact_event_t.hpp>
#include <vector>

#include "sync/resampling/contact_stream.h"
#include "sync/time/time.h"

namespace tactus::thermal {

// Input of one tick.
struct Tick {
  sync::HostTime begin{}, end{};         // on the host clock: the skin is real and ages in host time
  sync::SimTime sim_begin{}, sim_end{};  // the rendered interval of simulated time
  sync::ContactIntegral contact;         // over that interval; while the simulation is paused, that of its instant
  sync::Nanoseconds contact_interval{};  // interval over which `contact` is the mean
  std::vector<contact_event_t> events;   // events that have become due, of all tools
  sync::TimeMap map;                     // from simulated to host time
  sync::Nanoseconds delay{0};            // age of the rendered interval, in addition to kSettle

  double contact_interval_s() const { return sync::to_seconds(contact_interval); }
};

class Ticks {
 public:
  // Contacts more recent than this may still be in transit. Heat can wait for them (at 2.1 m/s, Fowler et al.
  // 1988, cold takes 0.4 s through 0.8 m of arm), so the interval ends this much before now and no part of a touch falls between two ticks.
  static constexpr sync::Nanoseconds kSettle{5'000'000};
  // A tick integrates at most this much simulated time, also after a long stop of the process.
  static constexpr sync::Nanoseconds kMaxInterval{2'000'000'000};

  // now: the clock; newest_arrival: actual arrival of the newest contact snapshot; delay: of presentation. A gap in
  // the stream while messages arrive is intended: the last contact is held. A silence makes the contact stale until messages arrive again.
  Tick next(sync::ContactStream& stream, sync::HostTime now, sync::HostTime newest_arrival, int tool,
            int tool_body, sync::Nanoseconds delay = sync::Nanoseconds(0));

 private:
  void hold(sync::ContactIntegral contact, sync::Nanoseconds interval);

  std::optional<sync::HostTime> end_;
  std::optional<sync::SimTime> sim_end_;
  sync::ContactIntegral contact_;
  sync::Nanoseconds contact_interval_{};
  std::int64_t restarts_ = 0;
};

}  // namespace tactus::thermal
