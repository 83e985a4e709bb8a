// Onset asynchronies of one pair of senses, in bins: bounded memory, quantiles good to half a bin.
#pragma once

#include <cstdint>
#include <vector>

#include "sync/time/time.h"

namespace tactus::sync {

class SoaHistogram {
 public:
  // 0.1 ms is a tenth of a haptic tick; beyond 2 s, which nobody would call one event, 10 ms will do. A delay and
  // a playout delay are at most 60 s each; what is beyond both counts at the edge.
  static constexpr Nanoseconds kBin{100'000};
  static constexpr Nanoseconds kRange{2'000'000'000};
  static constexpr Nanoseconds kWideBin{10'000'000};
  static constexpr Nanoseconds kWideRange{122'000'000'000};

  void add(Nanoseconds soa, Nanoseconds uncertainty);
  std::int64_t count() const { return count_; }
  // The largest half width of an interval that surely holds one of them.
  Nanoseconds uncertainty() const { return uncertainty_; }
  // How many are less than -before or more than after, both >= 0, to half a bin.
  std::int64_t beyond(Nanoseconds before, Nanoseconds after) const;
  // Interpolated within its bin; 0 when empty. 0 <= q <= 1.
  Nanoseconds quantile(double q) const;

 private:
  // Wide ones, narrow ones, wide ones.
  static constexpr std::int64_t kWide = (kWideRange - kRange) / kWideBin, kNarrow = 2 * kRange / kBin;
  static constexpr std::int64_t kBins = 2 * kWide + kNarrow;
  static Nanoseconds begin_of(std::int64_t bin);
  static std::int64_t bin_of(Nanoseconds soa);
  std::vector<std::int32_t> bins_ = std::vector<std::int32_t>(kBins, 0);
  std::int64_t first_ = kBins - 1, last_ = 0;  // bins that hold something: few of all, and asked for ten times a second
  std::int64_t count_ = 0;
  Nanoseconds uncertainty_{0};
};

}  // namespace tactus::sync
