// How far the clock of another host is ahead of ours, from two-way measurements. Pure.
//
// Each measurement is an interval that surely holds the offset at one instant; so is what is known from before, widened by
// what the clocks may have drifted apart since. Both hold, so their intersection does; an empty one says that the clock was
// turned faster than clocks drift, or jumped. What is published is a line inside of the interval: it slews towards its middle
// and never steps, except at the beginning and after a jump.
#pragma once

#include <cstdint>
#include <deque>

#include "sync/time/time.h"

namespace tactus::sync {

struct OffsetSample {
  HostTime at{};              // on our clock
  Nanoseconds offset{0};      // theirs minus ours
  Nanoseconds half_width{0};  // of the interval that surely holds it
};

// From the four times of a two-way probe (RFC 5905, section 8): sent and arrived back on our clock, arrived and replied on
// theirs. No message arrives before it was sent: offset <= arrived - sent there, >= replied - back here.
OffsetSample probe_sample(HostTime sent, HostTime arrived_there, HostTime replied_there, HostTime back);

struct OffsetLine {
  HostTime at{};
  Nanoseconds offset{0};
  double drift = 0;             // of the line: that of the clocks and the slew
  Nanoseconds uncertainty{0};   // half width of what surely holds the offset, at `at`
  double uncertainty_drift = 0;  // what it gains with the distance from `at`
  std::int32_t epoch = 0;
};

class OffsetTracker {
 public:
  // Of two clocks whose drift is not known yet: twice the +-100 ppm tolerance of a quartz.
  static constexpr double kMaxDrift = 200e-6;
  // How far a clock's rate strays from the mean that was measured: PHI, "frequency tolerance", RFC 5905, figure 5.
  static constexpr double kRateTolerance = 15e-6;
  // A rate is measured over up to so many waves, half a minute, between instants at least half a second apart: over less,
  // the uncertainty of both says nothing.
  static constexpr std::size_t kRemembered = 16;
  static constexpr Nanoseconds kShortestBase{500'000'000};
  // As fast as the kernel slews a clock: 500 ppm, RFC 5905, section 11.3 and adjtimex(2).
  static constexpr double kMaxSlew = 500e-6;
  // An error is slewed away in about so long, where that is not too fast (design: one period of the maps' consumers).
  static constexpr Nanoseconds kSlewTime{1'000'000'000};
  // Two clocks are read one after the other for one stamp (sync/clock_sync/probe_socket.cpp); a clock counts nanoseconds.
  static constexpr Nanoseconds kGranularity{1'000};

  enum class Outcome {
    kFirst,
    kNarrowed,     // agrees with what was known
    kRateChanged,  // agrees only if the rate has changed: it is measured anew
    kJumped,       // contradicts what was known: all is begun anew, in a new epoch
  };
  Outcome add(const OffsetSample& sample);

  // The line from `now` on. It continues the one before. Call in order of time, after the first sample.
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
  Rate tolerant() const;
  void begin(const OffsetSample&);
  void measure_rate();

  bool known_ = false;
  Nanoseconds base_{0};  // offsets are kept as differences from it: they may be larger than a double holds to the ns
  HostTime at_{};
  Interval interval_{0, 0};
  Rate rate_;
  std::deque<Measured> measured_;
  bool has_line_ = false;
  OffsetLine line_;
  std::int32_t epoch_ = 0;
};

}  // namespace tactus::sync
