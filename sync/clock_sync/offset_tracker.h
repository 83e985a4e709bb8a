// The offset between the clock of another host and ours, from two-way measurements. Pure.
//
// Each measurement is an interval that certainly contains the offset at one instant. So is the previous interval, widened by
// the possible drift since. The offset lies in their intersection. An empty intersection means that the clock was adjusted
// faster than clocks drift, or jumped. The published line lies inside of the interval: it slews towards the middle and never
// steps, except at the beginning and after a jump.
#pragma once

#include <cstdint>
#include <deque>

#include "sync/time/time.h"

namespace tactus::sync {

struct OffsetSample {
  HostTime at{};              // on our clock
  Nanoseconds offset{0};      // theirs minus ours
  Nanoseconds half_width{0};  // of the interval that certainly contains it
};

// From the four times of a two-way probe (RFC 5905, section 8): sent and returned on our clock, arrived and replied on
// theirs. No message arrives before it was sent: offset <= arrived - sent there, >= replied - back here.
OffsetSample probe_sample(HostTime sent, HostTime remote_arrival, HostTime remote_reply, HostTime returned);

struct OffsetLine {
  HostTime at{};
  Nanoseconds offset{0};
  double drift = 0;             // of the line: drift of the clocks plus slew
  Nanoseconds uncertainty{0};   // half width of the interval that certainly contains the offset, at `at`
  double uncertainty_drift = 0;  // growth with the distance from `at`
  std::int32_t epoch = 0;
};

class OffsetTracker {
 public:
  // Maximum drift between two clocks whose drift is unknown: twice the +-100 ppm tolerance of a quartz.
  static constexpr double kMaxDrift = 200e-6;
  // Deviation of a clock's rate from the measured mean: PHI, "frequency tolerance", RFC 5905, figure 5.
  static constexpr double kRateTolerance = 15e-6;
  // A rate is measured over up to this number of waves, half a minute, between instants at least half a second apart: over
  // less, the uncertainty of both ends exceeds the rate.
  static constexpr std::size_t kRemembered = 16;
  static constexpr Nanoseconds kMinBase{500'000'000};
  // The maximum slew of a clock by the kernel: 500 ppm, RFC 5905, section 11.3 and adjtimex(2).
  static constexpr double kMaxSlew = 500e-6;
  // Approximate time in which an error is slewed away, within kMaxSlew (design: one period of the maps' consumers).
  static constexpr Nanoseconds kSlewTime{1'000'000'000};
  // Two clocks are read one after the other for one stamp (sync/clock_sync/probe_socket.cpp); a clock counts nanoseconds.
  static constexpr Nanoseconds kGranularity{1'000};

  enum class Outcome {
    kFirst,
    kNarrowed,     // agrees with the previous interval
    kRateChanged,  // agrees only with a changed rate: it is measured again
    kJumped,       // contradicts the previous interval: everything restarts, in a new epoch
  };
  Outcome add(const OffsetSample& sample);

  // The line from `now` on. It continues the previous one. Call in order of time, after the first sample.
  OffsetLine line(HostTime now);
  std::int32_t epoch() const { return epoch_; }

 private:
  // ns relative to base_.
  struct Interval {
    double low, high;
    bool empty() const { return low > high; }
  };
  struct Measured {
    HostTime at;
    Interval interval;
  };
  struct Rate {
    double low = -kMaxDrift, high = kMaxDrift;
  };
  Interval relative(const OffsetSample&) const;
  Interval aged(HostTime t, Rate rate) const;
  Rate widened_rate() const;
  void begin(const OffsetSample&);
  void measure_rate();

  bool known_ = false;
  Nanoseconds base_{0};  // reference of stored offsets, which may exceed the ns precision of a double
  HostTime at_{};
  Interval interval_{0, 0};
  Rate rate_;
  std::deque<Measured> measured_;
  bool has_line_ = false;
  OffsetLine line_;
  std::int32_t epoch_ = 0;
};

}  // namespace tactus::sync
