// Follows one simulation on the bus: which incarnation is the present one, whether its time began anew, and the map
// from its time to our clock. Pure.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <tactus/header_t.hpp>
#include <tactus/sim_clock_t.hpp>

#include "sync/sender_clock.h"
#include "sync/time.h"

namespace tactus::sync {

enum class Follow {
  kSame,     // of the simulation that we follow
  kRestart,  // of a new one, or of the same whose time fell back: everything known before has ended
  kIgnore,   // of one that was replaced
};

class SimFollower {
 public:
  // A replaced incarnation is heard again only when its successor has been silent for so long.
  static constexpr Nanoseconds kSilence{300'000'000};
  // publish_time_ns falling back by more than this is a log replayed anew.
  static constexpr Nanoseconds kEpoch{1'000'000'000};
  static constexpr std::size_t kRemembered = 16;

  explicit SimFollower(OwnClock own) : own_(own) {}

  Follow follow(const header_t& header, const sim_clock_t& clock, HostTime arrival);
  // Nothing before the first message.
  std::optional<TimeMap> map(HostTime now) const;
  std::int64_t incarnation() const { return incarnation_; }

 private:
  OwnClock own_;
  std::int64_t incarnation_ = 0;
  std::int64_t newest_publish_ns_ = 0;
  HostTime last_arrival_{};
  std::deque<std::int64_t> replaced_;
  SenderClock sender_{own_};
  sim_clock_t clock_{};
};

}  // namespace tactus::sync
