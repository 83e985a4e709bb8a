// Reads the times of one sender on this host's clock, by the best that is known of its clock. Pure.
#pragma once

#include <cstdint>
#include <tactus/header_t.hpp>

#include "sync/clocks/clock_maps.h"
#include "sync/clocks/one_way_offset_estimator.h"
#include "sync/time/time.h"

namespace tactus::sync {

// In this order:
//   kSame     of our run and our clock: nothing to read
//   kMapped   of our run, and a map of its clock is published: good to the map's uncertainty
//   kOneWay   anything else, as a replayed log: by arrival, good to the smallest latency, which nobody knows
// A map is not believed for a while when the sender's stamps contradict it, for nothing arrives before it was sent: its clock
// has just jumped forward. A jump back looks like latency until the probes have noticed it, within three seconds.
class SenderClock {
 public:
  enum class ClockSource { kUnknown, kSame, kMapped, kOneWay };
  struct Reading {
    HostTime time{};
    ClockSource source = ClockSource::kUnknown;
    Nanoseconds uncertainty{-1};  // half width; -1: not known
  };
  // The next waves of probes have noticed the jump by then: two periods, their length and the maps' own.
  static constexpr Nanoseconds kDistrust{6'000'000'000};
  // A stamp that lies so far beyond its arrival contradicts the map. Arrivals read from a log are good to 1 us and the
  // recorder's own clock pairs to less than this (design).
  static constexpr Nanoseconds kTolerance{1'000'000};

  explicit SenderClock(OwnClock own) : own_(own) {}

  // True when the clock is seen to have jumped.
  bool observe(const header_t& header, HostTime arrival);

  bool known() const { return heard_; }
  Reading read(std::int64_t sender_ns, HostTime now) const;
  HostTime to_host(std::int64_t sender_ns, HostTime now) const { return read(sender_ns, now).time; }

 private:
  bool ours() const { return run_id_ == own_.run_id; }

  OwnClock own_;
  bool heard_ = false;
  std::int64_t run_id_ = 0;
  std::int32_t clock_ = 0;
  HostTime distrust_until_{};
  OneWayOffsetEstimator one_way_;
};

}  // namespace tactus::sync
