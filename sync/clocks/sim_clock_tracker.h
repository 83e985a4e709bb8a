// Follows one simulation on the bus: its current incarnation, restarts of its time, and the map from its time to our clock.
// Pure.
#pragma once

#include <cstdint>
#include <optional>
#include <tactus/header_t.hpp>
#include <tactus/sim_clock_t.hpp>

#include "sync/clocks/sender_clock.h"
#include "sync/clocks/single_sender.h"
#include "sync/time/time.h"

namespace tactus::sync {

enum class TrackResult {
  kSame,     // of the followed simulation
  kRestart,  // of a new one, or its time fell back: the known world has ended
  kIgnore,   // of another one while the followed one sends, or its time contradicts the most recent messages
};

class SimClockTracker {
 public:
  // A replaced incarnation is accepted again only when its successor has been silent for this time. A clock that contradicts
  // the messages is accepted after the same time.
  static constexpr Nanoseconds kSilence = SingleSender::kSilence;
  // A new incarnation is followed when the current one has been silent for this time. Shorter than the silence of a simulation
  // that is reset (its setting restart_silence, at least 80 ms).
  static constexpr Nanoseconds kTakeOver{75'000'000};
  // A publish_time_ns that falls back by more than this means that a log is replayed again.
  static constexpr Nanoseconds kMaxStepBack{1'000'000'000};
  // A clock that differs from the current one by more than this is accepted only when the current one has not been confirmed
  // for kSilence, so a forged message cannot shift the time.
  static constexpr Nanoseconds kMaxDeviation{1'000'000'000};

  explicit SimClockTracker(OwnClock own) : own_(own) {}

  TrackResult track(const header_t& header, const sim_clock_t& clock, HostTime arrival);
  // nullopt before the first message.
  std::optional<TimeMap> map(HostTime now) const;
  std::int64_t incarnation() const { return sender_of_world_.incarnation(); }
  // Whether a message is of the followed simulation. Call it after track().
  bool follows(const header_t& header) const {
    return known_ && header.incarnation == sender_of_world_.incarnation() && header.run_id == sender_of_world_.run_id();
  }
  // Whether another simulation has sent within the last 0.3 s. It is ignored, and its user should stop it.
  bool conflict(HostTime now) const { return sender_of_world_.conflict(now); }
  // A simulation publishes at most about 20 ms ahead, so a time more than kMaxDeviation ahead of the newest arrival is
  // invalid. Call it after track().
  SimTime latest_plausible() const { return map(last_arrival_).value_or(TimeMap{}).to_sim(last_arrival_) + kMaxDeviation; }

 private:
  bool contradicts(const header_t& header, const sim_clock_t& clock) const;

  OwnClock own_;
  SingleSender sender_of_world_{SingleSender::kAnyRun, kTakeOver};
  bool known_ = false;
  std::int64_t newest_publish_ns_ = 0;
  HostTime last_arrival_{};
  HostTime confirmed_{};
  SenderClock sender_{own_};
  sim_clock_t clock_{};
};

}  // namespace tactus::sync
