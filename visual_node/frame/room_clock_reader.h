// Reads the room's clock on the wall's host, from what sim_node says; and knows what it said by when. Pure.
#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <tactus/header_t.hpp>
#include <tactus/sim_clock_t.hpp>

#include "sync/clocks/sender_clock.h"
#include "sync/clocks/sim_clock_tracker.h"
#include "visual_node/frame/room_time.h"

namespace tactus::visual {

class RoomClockReader {
 public:
  // Of the past: a second of maps at 1 kHz.
  static constexpr std::size_t kMaps = 1024;

  explicit RoomClockReader(sync::OwnClock own) : own_(own), follower_(own), sender_(own) {}

  void hear(const header_t& header, const sim_clock_t& clock, sync::HostTime arrival);

  // Nothing was heard: nobody knows.
  bool known() const { return !told_.empty(); }
  // Counts the clocks that it has gone by: numbers of frames of another one mean nothing now.
  std::int64_t clocks() const { return clocks_; }
  // When what was heard last was sent. Only when known.
  RoomTime newest() const { return room_time(last_.publish_time_ns); }
  // False: neither ours nor mapped, it is read by arrival, good to the smallest latency.
  bool mapped(sync::HostTime now) const;
  // Only when known.
  sync::HostTime here(RoomTime t, sync::HostTime now) const;
  RoomTime room(sync::HostTime t, sync::HostTime now) const;
  // When somebody sent this, who may have a third clock.
  RoomTime sent(const header_t& header, sync::HostTime arrival) const;

  // The map of simulated time that sim_node had told by t, in the room's clock: the same on every wall that has
  // heard all of it, however long ago the others were drawn. Of what was told later the first, when there is
  // nothing else. Only when known.
  sim_clock_t told_by(RoomTime t) const;

 private:
  struct Told {
    RoomTime sent;
    sim_clock_t clock;
  };
  sync::OwnClock own_;
  sync::SimClockTracker follower_;
  sync::SenderClock sender_;
  header_t last_{};
  std::int64_t clocks_ = 0;
  std::deque<Told> told_;  // in order of time
};

}  // namespace tactus::visual
