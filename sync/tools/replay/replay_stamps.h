// Makes recorded messages messages of the live run: stamped when they would have been sent, had the world happened
// now and at this speed. Pure.
//
// Written into the bytes are run, clock, publish time and incarnation of the header, and the simulation's map
// between its time and its host's (sim_clock_t, behind the header of those types that have one). So receivers read
// all times as those of a neighbour, exactly, at any speed and without a CLOCK_MAP for a clock that does not
// exist. Numbers (seq) stay: a message that the log lacks is a gap in the replay, too.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string_view>
#include <utility>

#include "sync/clocks/clock_maps.h"
#include "sync/bus/identity.h"
#include "sync/log/log_origin.h"
#include "sync/clocks/sender_clock.h"

namespace tactus::sync {

// When a recorded event is played.
struct ReplayMoment {
  HostTime recorded;      // arrival at the recorder, its clock
  HostTime live;          // the same instant on our clock
  double speed = 1;       // recorded seconds per live second
  std::int64_t pass = 0;  // changes with each jump: senders are born anew, so that nobody takes old for repeated
};

class ReplayStamps {
 public:
  // Senders of a log; noise makes up more.
  static constexpr std::size_t kMaxSenders = 256;
  // As fast as any receiver believes a simulation to run (lcmtypes/valid.cpp).
  static constexpr double kMaxRate = 100;

  ReplayStamps(const LogOrigin& origin, Identity live);
  // Every event of the log, in order, before it is restamped or left out.
  void hear(const LogEvent& event, const ReplayMoment& moment);
  // False, and nothing is changed: this is no message of ours.
  bool restamp(std::span<std::uint8_t> message, const ReplayMoment& moment, HostTime now);

 private:
  LogOrigin origin_;
  Identity live_;
  ClockMaps maps_;
  std::int64_t pass_ = 0;
  std::map<std::pair<std::int32_t, std::int64_t>, SenderClock> senders_;  // by source, incarnation
};

}  // namespace tactus::sync
