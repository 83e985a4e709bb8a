// The pose of a device that reports it many times a second, at an instant of the host clock: interpolated between reports,
// extrapolated past the newest for a bounded time, then held. Pure.
#pragma once

#include <deque>
#include <tactus/tool_state_t.hpp>

#include "sync/resampling/body_history.h"
#include "sync/resampling/sample_status.h"
#include "sync/clocks/sender_clock.h"
#include "sync/clocks/single_sender.h"
#include "sync/time/time.h"

namespace tactus::sync {

// The device of one tool, from TOOL_STATE. Samples are ordered by the time at which the device was read, not by simulated
// time: a head moves also while the world stands still.
class PoseHistory {
 public:
  // design: a longer extrapolation of the eye overshoots visibly when the head stops
  static constexpr Nanoseconds kMaxExtrapolation{20'000'000};
  // design: as for the bodies of the world
  static constexpr Nanoseconds kStaleAfter{200'000'000};
  // Length of the stored past, beyond the delay of extend_history(): 4096 reports at 4 kHz.
  static constexpr Nanoseconds kSpan{1'000'000'000};
  static constexpr std::size_t kMaxSamples = 4096;

  // own: times on another clock are converted by its map; times of another run by arrival.
  explicit PoseHistory(OwnClock own) : sender_(own), own_(own) {}

  // Stores this time beyond kSpan, for a view that a profile delays.
  void extend_history(Nanoseconds delay) { span_ = kSpan + delay; }
  // A report. Those of a second process of the tool are ignored while the first one sends.
  void push(const tool_state_t& state, HostTime arrival);
  // Whether a second process of the tool has sent within the last 0.3 s.
  bool conflict(HostTime now) const { return followed_.conflict(now); }
  // Removes all reports, because they belong to an earlier world.
  void clear() { samples_.clear(); }
  // kNone: no report has arrived. After kStaleAfter it is the last pose with kStale.
  Sample<BodyPose> at(HostTime t) const;

 private:
  struct TimedPose {
    HostTime time;
    BodyPose pose;
  };
  SenderClock sender_;
  OwnClock own_;
  SingleSender followed_;
  std::deque<TimedPose> samples_;  // in order of time
  Nanoseconds span_ = kSpan;
};

}  // namespace tactus::sync
