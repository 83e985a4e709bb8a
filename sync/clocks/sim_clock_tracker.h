// Follows one simulation on the bus: which incarnation is the present one, whether its time began anew, and the
// map from its time to our clock. Pure.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <tactus/header_t.hpp>
#include <tactus/sim_clock_t.hpp>

#include "sync/clocks/sender_clock.h"
#include "sync/time/time.h"

namespace tactus::sync {

enum class TrackResult {
  kSame,     // of the simulation that we follow
  kRestart,  // of a new one, or of the same whose time fell back: everything known before has ended
  kIgnore,   // of one that was replaced, or its time contradicts what was heard just now
};

class SimClockTracker {
 public:
  // A replaced incarnation is heard again only when its successor has been silent for so long.
  static constexpr Nanoseconds kSilence{300'000'000};
  // publish_time_ns falling back by more than this is a log replayed anew.
  static constexpr Nanoseconds kEpoch{1'000'000'000};
  // A clock that lies farther from the present one than this is believed only when that one has not been confirmed
  // for kSilence: a forged message moves nobody's time.
  static constexpr Nanoseconds kFar{1'000'000'000};
  static constexpr std::size_t kRemembered = 16;

  explicit SimClockTracker(OwnClock own) : own_(own) {}

  TrackResult follow(const header_t& header, const sim_clock_t& clock, HostTime arrival);
  // Nothing before the first message.
  std::optional<TimeMap> map(HostTime now) const;
  std::int64_t incarnation() const { return incarnation_; }
  // Nothing that a simulation publishes lies farther ahead than some 20 ms, so what lies kFar ahead of the newest
  // arrival is false. Call after follow.
  SimTime latest_credible() const { return map(last_arrival_).value_or(TimeMap{}).to_sim(last_arrival_) + kFar; }

 private:
  bool contradicts(const header_t& header, const sim_clock_t& clock) const;

  OwnClock own_;
  std::int64_t incarnation_ = 0;
  std::int64_t newest_publish_ns_ = 0;
  HostTime last_arrival_{};
  HostTime confirmed_{};
  std::deque<std::int64_t> replaced_;
  SenderClock sender_{own_};
  sim_clock_t clock_{};
};

}  // namespace tactus::sync
