// Maps the clock of one sender to this host's clock.
#pragma once

#include <cstdint>

#include "sync/time.h"

namespace tactus::sync {

// One-way estimator (Olson, "A passive solution to the sensor synchronization problem", IROS 2010): every arrival
// bounds the offset, because latency is never negative: offset = sender - host >= stamp - arrival. The largest bound is
// kept and relaxed with its age by the worst drift of the two clocks. The bias is the smallest latency seen.
//
// A sender of the same run on the same host has the same clock: then the offset is 0 and nothing is estimated.
class SenderClock {
 public:
  // Worst relative drift of two quartz clocks: 200 ppm is twice the usual +-100 ppm tolerance of one.
  static constexpr double kMaxDrift = 200e-6;
  // A bound that falls below the kept one by more than this is no latency but a clock that jumped.
  static constexpr Nanoseconds kJump{2'000'000'000};

  // stamp_ns: the sender's CLOCK_MONOTONIC; same_clock: it is known to be ours. Returns true when the clock jumped and
  // the estimate was begun anew.
  bool observe(std::int64_t stamp_ns, HostTime arrival, bool same_clock);

  bool known() const { return known_; }
  // On this host's clock. Unknown clocks map to themselves.
  HostTime to_host(std::int64_t sender_ns, HostTime now) const;

 private:
  Nanoseconds offset_at(HostTime now) const;

  bool known_ = false;
  bool same_clock_ = false;
  Nanoseconds offset_{0};  // sender - host when last improved
  HostTime improved_{};
};

}  // namespace tactus::sync
