// Lengths of the visual steps in whole haptic ticks. Pure.
#pragma once

#include <cstdint>

#include "sync/time/time.h"

namespace tactus::sim {

class VisualRate {
 public:
  // Design: 240 Hz is also the limit of snapshots (setting state_rate); below 10 Hz motion is not perceived as
  // continuous.
  static constexpr double kMin_Hz = 10, kMax_Hz = 240;

  VisualRate(double rate_Hz, sync::Nanoseconds tick) : tick_(tick) { set(rate_Hz); }

  // Applies from the next step on; clamps to the limits.
  void set(double rate_Hz);
  double rate_Hz() const { return rate_Hz_; }
  // Length of the next step. Step n begins at the first tick at or after n / rate; at 60 Hz a step has 16 or 17 ticks
  // of 1 ms.
  sync::Nanoseconds next();

  template <class Archive>
  void archive(Archive& a) {
    a(rate_Hz_), a(steps_), a(begun_);
  }

 private:
  sync::Nanoseconds tick_;
  double rate_Hz_ = 60;
  std::int64_t steps_ = 0, begun_ = 0;  // since the rate was set: number of steps, and of the ticks that they last
};

}  // namespace tactus::sim
