// How long the visual steps are, in whole haptic ticks. Pure.
#pragma once

#include <cstdint>

#include "sync/time/time.h"

namespace tactus::sim {

class VisualRate {
 public:
  // Pictures are not shown faster than 240 Hz, as snapshots are not (setting state_rate); slower than 10 Hz
  // nothing is seen to move (design).
  static constexpr double kLeast_Hz = 10, kMax_Hz = 240;

  VisualRate(double rate_Hz, sync::Nanoseconds tick) : tick_(tick) { set(rate_Hz); }

  // Steps from the next one on; beyond the limits the nearest.
  void set(double rate_Hz);
  double rate_Hz() const { return rate_Hz_; }
  // The length of the next step: step n begins at the first tick that is not before n / rate, so that at 60 Hz
  // lengths are 16 or 17 ticks of 1 ms.
  sync::Nanoseconds next();

  template <class Archive>
  void archive(Archive& a) {
    a(rate_Hz_), a(steps_), a(begun_);
  }

 private:
  sync::Nanoseconds tick_;
  double rate_Hz_ = 60;
  std::int64_t steps_ = 0, begun_ = 0;  // steps since the rate was set, and the ticks that they last
};

}  // namespace tactus::sim
