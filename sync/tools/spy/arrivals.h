// Rate and jitter of the messages of one sender on one channel. Pure; bounded.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>

#include "sync/time/time.h"

namespace tactus::sync::spy {

class Arrivals {
 public:
  // The evaluated messages: the last two seconds, at most this number (1 kHz).
  static constexpr Nanoseconds kSpan{2'000'000'000};
  static constexpr std::size_t kMax = 2048;

  void add(HostTime arrival, std::size_t bytes);

  // 1/s and bytes/s over the span, or over the stored messages where they cover less. 0: fewer than two.
  double rate_Hz(HostTime now) const;
  double bytes_per_s(HostTime now) const;
  // Deviation of the time between two messages from the median of these times, ms: its median and its 99 % quantile. 0: fewer
  // than three messages.
  struct Jitter {
    double p50_ms = 0, p99_ms = 0;
  };
  Jitter jitter(HostTime now) const;
  HostTime newest() const { return kept_.empty() ? HostTime{} : kept_.back().arrival; }

 private:
  struct Kept {
    HostTime arrival;
    std::uint32_t bytes;
  };
  // The first message within the span.
  std::size_t first(HostTime now) const;
  std::deque<Kept> kept_;
};

}  // namespace tactus::sync::spy
