// Reads the room's clock on the wall's host from the messages of sim_node, and stores its published time maps.
// Pure.
#pragma once

#include <cstddef>
#include <deque>
#include <tactus/header_t.hpp>
#include <tactus/sim_clock_t.hpp>

#include "sync/clocks/sender_clock.h"
#include "sync/clocks/sim_clock_tracker.h"
#include "visual_node/frame/room_time.h"

namespace tactus::visual {

class RoomClockReader {
 public:
  // Stored maps: a second at 1 kHz.
  static constexpr std::size_t kMaps = 1024;

  explicit RoomClockReader(sync::OwnClock own) : own_(own), tracker_(own), sender_(own) {}

  void on_message(const header_t& header, const sim_clock_t& clock, sync::HostTime arrival);

  // False before the first message.
  bool known() const { return !maps_.empty(); }
  // Counts the clocks used so far; a change makes earlier frame numbers invalid.
  std::int64_t clocks() const { return clocks_; }
  // Send time of the last message. Only when known().
  RoomTime newest() const { return room_time(last_.publish_time_ns); }
  // False: the clock is neither ours nor mapped; it is read by arrival, accurate to the smallest latency.
  bool mapped(sync::HostTime now) const;
  // Convert between the room's clock and this host's. Only when known().
  sync::HostTime to_host(RoomTime t, sync::HostTime now) const;
  RoomTime to_room(sync::HostTime t, sync::HostTime now) const;
  // Send time of a message whose sender may have a third clock.
  RoomTime sent(const header_t& header, sync::HostTime arrival) const;

  // The map of simulated time that sim_node had published by t, in the room's clock: the same on every wall that
  // has received all of them, whenever it asks. Returns the first later map when there is no earlier one. Only
  // when known().
  sim_clock_t published_by(RoomTime t) const;

 private:
  struct PublishedMap {
    RoomTime sent;
    sim_clock_t clock;
  };
  sync::OwnClock own_;
  sync::SimClockTracker tracker_;
  sync::SenderClock sender_;
  header_t last_{};
  std::int64_t clocks_ = 0;
  std::deque<PublishedMap> maps_;  // in order of time
};

}  // namespace tactus::visual
