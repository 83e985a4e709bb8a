// When each sample of a stream is physically out, on the host clock. Pure.
#pragma once

#include "sync/time/time.h"

namespace tactus::audio {

// What PortAudio says in one callback (its clock is CLOCK_MONOTONIC, CLOCK_REALTIME or a frame counter, depending
// on what is behind it) and the host clock at that moment.
struct CallbackTime {
  double current_s = 0;  // PortAudio's time of the call
  double dac_s = 0;      // PortAudio's time at which the block's first sample is out
  sync::HostTime now{};  // host clock
  bool underflow = false;
};

// Offset of PortAudio's clock: running minimum of (now - current), since the callback can only be late; begun anew
// when that clock steps, to either side, by more than a callback is late. The times
// of successive blocks are smoothed by a second-order delay-locked loop (Adriaensen, "Using a DLL to filter time",
// Linux Audio Conference 2005) and begun anew after an underflow or a jump. Realtime-safe: yes.
class DacClock {
 public:
  explicit DacClock(double rate_Hz) : rate_Hz_(rate_Hz) {}

  struct Estimate {
    sync::HostTime first_sample{};
    sync::Nanoseconds uncertainty{0};
  };
  // latency_s: what the stream claims, used where PortAudio's times are implausible (0, or not in the future by
  // less than a second: several host APIs do that).
  Estimate block(int frames, const CallbackTime& time, double latency_s);

  // Frames per host second as measured, 1/s.
  double rate_Hz() const { return rate_Hz_ / period_; }
  long reseeds() const { return reseeds_; }

 private:
  double offset_s(const CallbackTime& time);
  void seed(double raw_s);

  double rate_Hz_;
  sync::HostTime base_{};  // first call: small numbers keep nanoseconds in doubles
  bool based_ = false;
  // Two windows of minima, so that an old minimum is forgotten when the two clocks drift.
  double minimum_s_ = 0, older_minimum_s_ = 0, window_end_s_ = 0;
  bool calibrated_ = false;
  // Calls in a row that came late by the minimum, and the least late of them.
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
