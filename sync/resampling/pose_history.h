// Where something is that reports its pose many times a second, at an instant of the host: interpolated between
// reports, carried on past the newest for a bounded time, then held. Pure.
#pragma once

#include <deque>
#include <optional>
#include <tactus/tool_state_t.hpp>

#include "sync/resampling/body_history.h"
#include "sync/resampling/sample_status.h"
#include "sync/clocks/sender_clock.h"
#include "sync/time/time.h"

namespace tactus::sync {

// The device of one tool, from TOOL_STATE. By the times at which it was read, not by those of the world: a head
// goes on moving when the world stands still.
class PoseHistory {
 public:
  // design: an eye that goes on for longer than a frame overshoots visibly when the head stops.
  static constexpr Nanoseconds kExtrapolateAtMost{20'000'000};
  // design: as long as for the bodies of the world.
  static constexpr Nanoseconds kStaleAfter{200'000'000};
  // So much of the past is kept, for a sense that presents late: of 4 kHz 4096 reports.
  static constexpr Nanoseconds kSpan{1'000'000'000};
  static constexpr std::size_t kMaxSamples = 4096;

  // own: reports of another clock are read through its map; those of another run by arrival.
  explicit PoseHistory(OwnClock own) : sender_(own), own_(own) {}

  void push(const tool_state_t& state, HostTime arrival);
  // What was heard is of a world that is no more.
  void forget() { samples_.clear(); }
  // kNone: nothing was ever heard. Past kStaleAfter it is still the last pose, and kStale.
  Sample<BodyPose> at(HostTime t) const;

 private:
  struct Stamped {
    HostTime time;
    BodyPose pose;
  };
  SenderClock sender_;
  OwnClock own_;
  std::int64_t incarnation_ = 0;
  std::deque<Stamped> samples_;  // in order of time
};

}  // namespace tactus::sync
