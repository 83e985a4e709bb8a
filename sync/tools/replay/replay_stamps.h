// Converts recorded messages to messages of the live run: stamped with the time at which they would have been sent, if the
// world happened now and at this speed. Pure.
//
// It overwrites run, clock, publish time and incarnation in the encoded header, and the simulation's map between its time and
// its host's (sim_clock_t, after the header of those types that have one). So receivers read all times as those of a sender
// on this host, exactly, at any speed and without a CLOCK_MAP for a clock that does not exist. Sequence numbers (seq) stay: a
// message that the log lacks is a gap in the replay, too.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <utility>

#include "sync/clocks/clock_maps.h"
#include "sync/bus/identity.h"
#include "sync/log/log_origin.h"
#include "sync/clocks/sender_clock.h"

namespace tactus::sync {

// The time at which a recorded event is played.
struct ReplayMoment {
  HostTime recorded;      // arrival at the recorder, its clock
  HostTime live;          // the same instant on our clock
  double speed = 1;       // recorded seconds per live second
  std::int64_t pass = 0;  // changes with each jump: senders get new incarnations, so that receivers do not take old messages
                          // for repetitions
};

class ReplayStamps {
 public:
  // Senders of a log; random bytes create more.
  static constexpr std::size_t kMaxSenders = 256;
  // The highest simulation rate that a receiver accepts (lcmtypes/valid.cpp).
  static constexpr double kMaxRate = 100;

  ReplayStamps(const LogOrigin& origin, Identity live);
  // Call it for every event of the log, in order, before it is restamped or left out.
  void observe(const LogEvent& event, const ReplayMoment& moment);
  // Returns false, without a change, when the bytes are not a message of this system.
  bool restamp(std::span<std::uint8_t> message, const ReplayMoment& moment, HostTime now);

 private:
  LogOrigin origin_;
  Identity live_;
  ClockMaps maps_;
  std::int64_t pass_ = 0;
  std::map<std::pair<std::int32_t, std::int64_t>, SenderClock> senders_;  // by source, incarnation
};

}  // namespace tactus::sync
