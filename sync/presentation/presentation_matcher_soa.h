// A histogram of the onset asynchronies of one pair of modalities: memory of the bins in use, quantiles accurate to half a bin.
#pragma once

#include <array>
#include <cstdint>
#include <map>

#include "sync/time/time.h"

namespace tactus::sync {

class SoaHistogram {
 public:
  // 0.1 ms is a tenth of a haptic tick; beyond 2 s, where two onsets are no longer one event, 10 ms suffice. The delay of a
  // profile and a playout delay are at most 60 s each; larger sums count at the edge.
  static constexpr Nanoseconds kBin{100'000};
  static constexpr Nanoseconds kRange{2'000'000'000};
  static constexpr Nanoseconds kWideBin{10'000'000};
  static constexpr Nanoseconds kWideRange{122'000'000'000};

  void add(Nanoseconds soa, Nanoseconds uncertainty);
  std::int64_t count() const { return count_; }
  // The largest half width of an interval that certainly contains one of the asynchronies.
  Nanoseconds uncertainty() const { return uncertainty_; }
  // The number of asynchronies less than -before or more than after, both >= 0, to half a bin.
  std::int64_t beyond(Nanoseconds before, Nanoseconds after) const;
  // Interpolated within its bin; 0 when empty. 0 <= q <= 1.
  Nanoseconds quantile(double q) const;

 private:
  // Wide bins, narrow bins, wide bins.
  static constexpr std::int64_t kWide = (kWideRange - kRange) / kWideBin, kNarrow = 2 * kRange / kBin;
  static Nanoseconds begin_of(std::int64_t bin);
  static std::int64_t bin_of(Nanoseconds soa);
  // Calls use(bin, count) for each bin that counts, in order, until it returns true.
  template <class Use>
  void each_bin(Use use) const;
  // The bins of a block have memory once one of them counts: a pair uses few of all.
  static constexpr std::int64_t kBlock = 64;
  std::map<std::int64_t, std::array<std::int32_t, kBlock>> blocks_;
  std::int64_t last_ = 0;  // the last bin that counts
  std::int64_t count_ = 0;
  Nanoseconds uncertainty_{0};
};

}  // namespace tactus::sync
