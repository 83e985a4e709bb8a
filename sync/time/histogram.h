// A histogram of durations in logarithmic bins: constant size, mergeable, accurate to 19 % (a quarter octave) a bin.
#pragma once

#include <array>
#include <cstdint>
#include <tactus/histogram_t.hpp>

#include "sync/time/time.h"

namespace tactus::sync {

// Bin 0 holds durations below 1 us; bin i > 0 holds 2^((i-1)/4) .. 2^(i/4) us; the last one all longer ones (from 0.8 s).
class Histogram {
 public:
  static constexpr int kBins = 80;

  // Realtime-safe: yes.
  void add(Nanoseconds duration);
  std::int64_t count() const;
  // Interpolated within its bin, never above the maximum seen; 0 when empty. 0 <= q <= 1.
  Nanoseconds quantile(double q) const;
  Nanoseconds max() const { return max_; }

  // Adds the counts of another histogram.
  void merge(const Histogram& other);
  histogram_t to_message() const;
  static Histogram from_message(const histogram_t&);

 private:
  std::array<std::int32_t, kBins> bins_{};
  Nanoseconds max_{0};
};

}  // namespace tactus::sync
