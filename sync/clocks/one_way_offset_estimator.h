// Estimates the offset of a sender's clock from its time stamps alone. Pure.
#pragma once

#include <cstdint>

#include "sync/time/time.h"

namespace tactus::sync {

// One-way estimator (Olson, "A passive solution to the sensor synchronization problem", IROS 2010). Latency is never
// negative, so every arrival bounds the offset: offset = sender - host >= stamp - arrival. The largest bound is kept and
// relaxed with its age by the worst drift of the two clocks. The bias is the smallest latency seen.
//
// A clock that jumps forward gives a larger bound, which is adopted immediately. A clock that jumps back looks like latency.
// Latency varies, so when all bounds of kWindow lie below the kept one, the best of them is adopted. The relaxation corrects
// a jump smaller than kMinJump within kMinJump / kMaxDrift = 25 s.
class OneWayOffsetEstimator {
 public:
  // Worst relative drift of two quartz clocks: 200 ppm is twice the usual +-100 ppm tolerance of one.
  static constexpr double kMaxDrift = 200e-6;
  // A bound that falls below the kept one by more than this is a clock jump, not latency.
  static constexpr Nanoseconds kJump{2'000'000'000};
  // Design: less than a perceptible haptic-visual asynchrony, more than the jitter of an idle network.
  static constexpr Nanoseconds kMinJump{5'000'000};
  static constexpr Nanoseconds kWindow{2'000'000'000};
  static constexpr int kWindowStamps = 4;  // design: fewer may all have been delayed by one cause

  // stamp_ns: the sender's CLOCK_MONOTONIC. Returns true when the clock jumped and the estimate was restarted.
  bool observe(std::int64_t stamp_ns, HostTime arrival);

  bool known() const { return known_; }
  // On this host's clock. An unknown clock maps to itself.
  HostTime to_host(std::int64_t sender_ns, HostTime now) const;

 private:
  Nanoseconds offset_at(HostTime now) const;
  void adopt(Nanoseconds bound, HostTime arrival);
  // True when all bounds of a whole window were too low.
  bool low_for_window(Nanoseconds bound, HostTime arrival);

  bool known_ = false;
  Nanoseconds offset_{0};  // sender - host when last improved
  HostTime improved_{};
  // The stamps since bounds are too low: their number, the first time, and the best bound.
  int low_count_ = 0;
  HostTime low_since_{};
  Nanoseconds max_low_bound_{0};
  HostTime max_low_bound_at_{};
};

}  // namespace tactus::sync
