// The clock of a sender that is known from its stamps alone. Pure.
#pragma once

#include <cstdint>

#include "sync/time/time.h"

namespace tactus::sync {

// One-way estimator (Olson, "A passive solution to the sensor synchronization problem", IROS 2010): every arrival
// bounds the offset, because latency is never negative: offset = sender - host >= stamp - arrival. The largest bound is
// kept and relaxed with its age by the worst drift of the two clocks. The bias is the smallest latency seen.
//
// A clock that was put forward gives a larger bound: taken at once. One that was put back looks like latency; it is told
// from it because latency comes and goes: when all bounds of kWindow lie below the kept one, the best of them is taken. What
// is smaller than kNoticed is made good by the relaxation, within kNoticed / kMaxDrift = 25 s.
class OneWayOffsetEstimator {
 public:
  // Worst relative drift of two quartz clocks: 200 ppm is twice the usual +-100 ppm tolerance of one.
  static constexpr double kMaxDrift = 200e-6;
  // A bound that falls below the kept one by more than this is no latency but a clock that jumped.
  static constexpr Nanoseconds kJump{2'000'000'000};
  // Design: less than a haptic-visual asynchrony that anyone notices, more than the jitter of an idle network.
  static constexpr Nanoseconds kNoticed{5'000'000};
  static constexpr Nanoseconds kWindow{2'000'000'000};
  static constexpr int kWindowStamps = 4;  // design: fewer may all have been delayed by one cause

  // stamp_ns: the sender's CLOCK_MONOTONIC. True when the clock jumped and the estimate was begun anew.
  bool observe(std::int64_t stamp_ns, HostTime arrival);

  bool known() const { return known_; }
  // On this host's clock. An unknown clock maps to itself.
  HostTime to_host(std::int64_t sender_ns, HostTime now) const;

 private:
  Nanoseconds offset_at(HostTime now) const;
  void take(Nanoseconds bound, HostTime arrival);
  // True when everything of a whole window lay too low.
  bool low_for_long(Nanoseconds bound, HostTime arrival);

  bool known_ = false;
  Nanoseconds offset_{0};  // sender - host when last improved
  HostTime improved_{};
  // The stamps since bounds lie too low: how many, since when, and the best of them.
  int low_ = 0;
  HostTime low_since_{};
  Nanoseconds best_low_{0};
  HostTime best_low_at_{};
};

}  // namespace tactus::sync
