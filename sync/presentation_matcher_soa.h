// Onset asynchronies of one pair of senses, in bins of fixed width: bounded memory, quantiles good to half a bin.
#pragma once

#include <cstdint>
#include <vector>

#include "sync/time.h"

namespace tactus::sync {

class SoaHistogram {
 public:
  // 0.1 ms is a tenth of a haptic tick; 2 s is beyond what anyone would call one event. What is beyond counts at the edge.
  static constexpr Nanoseconds kBin{100'000};
  static constexpr Nanoseconds kRange{2'000'000'000};

  void add(Nanoseconds soa, Nanoseconds uncertainty);
  std::int64_t count() const { return count_; }
  // The largest half width of an interval that surely holds one of them.
  Nanoseconds uncertainty() const { return uncertainty_; }
  // How many are less than -before or more than after, both >= 0, to half a bin.
  std::int64_t beyond(Nanoseconds before, Nanoseconds after) const;
  // Interpolated within its bin; 0 when empty. 0 <= q <= 1.
  Nanoseconds quantile(double q) const;

 private:
  static constexpr std::int64_t kBins = 2 * kRange / kBin;
  std::vector<std::int32_t> bins_ = std::vector<std::int32_t>(kBins, 0);
  std::int64_t count_ = 0;
  Nanoseconds uncertainty_{0};
};

}  // namespace tactus::sync
