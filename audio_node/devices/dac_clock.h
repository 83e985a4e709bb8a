// Host time at which each sample of a stream is physically out. Pure.
#pragma once

#include "sync/time/time.h"

namespace tactus::audio {

// Times that PortAudio reports in one callback (its clock is CLOCK_MONOTONIC, CLOCK_REALTIME or a frame counter,
// depending on the host API) and the host clock at that moment.
struct CallbackTime {
  double current_s = 0;  // PortAudio time of the call
  double dac_s = 0;      // PortAudio time at which the first sample of the block is out
  sync::HostTime now{};  // host clock
  bool underflow = false;
};

// Offset of the PortAudio clock: running minimum of (now - current), since the callback can only be late;
// restarted when that clock steps, in either direction, by more than the lateness of a callback. The times of
// successive blocks are smoothed by a second-order delay-locked loop (Adriaensen, "Using a DLL to filter time",
// Linux Audio Conference 2005), which restarts after an underflow or a jump. Realtime-safe: yes.
class DacClock {
 public:
  explicit DacClock(double rate_Hz) : rate_Hz_(rate_Hz) {}

  struct Estimate {
    sync::HostTime first_sample{};
    sync::Nanoseconds uncertainty{0};
  };
  // latency_s: as the stream reports it, used where the times of PortAudio are implausible (0, or not in the
  // future by less than a second, as with several host APIs).
  Estimate block(int frames, const CallbackTime& time, double latency_s);

  // Measured frames per host second, 1/s.
  double rate_Hz() const { return rate_Hz_ / period_; }
  long reseeds() const { return reseeds_; }

 private:
  double offset_s(const CallbackTime& time);
  void seed(double raw_s);

  double rate_Hz_;
  sync::HostTime base_{};  // first call: small numbers keep nanoseconds in doubles
  bool based_ = false;
  // Two windows of minima, so that an old minimum expires when the two clocks drift.
  double minimum_s_ = 0, older_minimum_s_ = 0, window_end_s_ = 0;
  bool calibrated_ = false;
  // Number of consecutive calls that were late against the minimum, and the smallest offset among them.
  int late_ = 0;
  double late_minimum_s_ = 0;
  double next_s_ = 0;     // predicted time of the next block since base_
  double period_ = 1;     // host seconds per nominal second
  double square_s2_ = 0;  // mean square of the residual
  long blocks_ = 0;       // since seeded
  int outliers_ = 0;
  long reseeds_ = 0;
};

}  // namespace tactus::audio
