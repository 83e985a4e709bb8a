// Converts the times of one sender to this host's clock, by the best available source. Pure.
#pragma once

#include <cstdint>
#include <tactus/header_t.hpp>

#include "sync/clocks/clock_maps.h"
#include "sync/clocks/one_way_offset_estimator.h"
#include "sync/time/time.h"

namespace tactus::sync {

// In order of precedence:
//   kSame     this run and this clock: no conversion
//   kMapped   this run, and a map of the sender's clock is published: accurate to the map's uncertainty
//   kOneWay   all else, such as a replayed log: by arrival, accurate to the smallest latency, which is unknown
// A map is distrusted for a while when stamps of the sender contradict it, because no message arrives before it was sent: the
// sender's clock has just jumped forward. A jump back looks like latency until the probes detect it, within three seconds.
class SenderClock {
 public:
  enum class ClockSource { kUnknown, kSame, kMapped, kOneWay };
  struct Reading {
    HostTime time{};
    ClockSource source = ClockSource::kUnknown;
    Nanoseconds uncertainty{-1};  // half width; -1: unknown
  };
  // Duration of the distrust. The next waves of probes have detected the jump by then: two periods, their length, and the
  // period of the maps.
  static constexpr Nanoseconds kDistrust{6'000'000'000};
  // A stamp this far beyond its arrival contradicts the map. Arrivals read from a log are accurate to 1 us, and the
  // recorder's own clock pairs to less than this (design).
  static constexpr Nanoseconds kTolerance{1'000'000};

  explicit SenderClock(OwnClock own) : own_(own) {}

  // Returns true when a jump of the clock was detected.
  bool observe(const header_t& header, HostTime arrival);

  Reading read(std::int64_t sender_ns, HostTime now) const;
  HostTime to_host(std::int64_t sender_ns, HostTime now) const { return read(sender_ns, now).time; }

 private:
  bool same_run() const { return run_id_ == own_.run_id; }

  OwnClock own_;
  bool known_ = false;
  std::int64_t run_id_ = 0;
  std::int32_t clock_ = 0;
  HostTime distrust_until_{};
  OneWayOffsetEstimator one_way_;
};

}  // namespace tactus::sync
