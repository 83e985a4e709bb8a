#include "sync/presentation/presentation_matcher_soa.h"

#include <algorithm>
#include <cmath>

namespace tactus::sync {

Nanoseconds SoaHistogram::begin_of(std::int64_t bin) {
  if (bin < kWide) return bin * kWideBin - kWideRange;
  if (bin < kWide + kNarrow) return (bin - kWide) * kBin - kRange;
  return (bin - kWide - kNarrow) * kWideBin + kRange;
}

std::int64_t SoaHistogram::bin_of(Nanoseconds soa) {
  const Nanoseconds inside = std::clamp(soa, -kWideRange, kWideRange - Nanoseconds(1));
  if (inside < -kRange) return (inside + kWideRange) / kWideBin;
  if (inside < kRange) return kWide + (inside + kRange) / kBin;
  return kWide + kNarrow + (inside - kRange) / kWideBin;
}

void SoaHistogram::add(Nanoseconds soa, Nanoseconds uncertainty) {
  const std::int64_t bin = bin_of(soa);
  ++blocks_[bin / kBlock][static_cast<std::size_t>(bin % kBlock)];
  last_ = std::max(last_, bin);
  ++count_;
  uncertainty_ = std::max(uncertainty_, uncertainty);
}

template <class Use>
void SoaHistogram::each_bin(Use use) const {
  for (const auto& [number, counts] : blocks_)
    for (std::int64_t i = 0; i < kBlock; ++i)
      if (const std::int32_t n = counts[static_cast<std::size_t>(i)]; n > 0 && use(number * kBlock + i, n)) return;
}

Nanoseconds SoaHistogram::quantile(double q) const {
  if (count_ == 0) return Nanoseconds(0);
  const double target = q * static_cast<double>(count_);
  double below = 0, here = 1;
  std::int64_t found = last_;
  each_bin([&](std::int64_t bin, std::int32_t n) {
    found = bin, here = n;
    if (bin == last_ || below + here >= target) return true;
    below += here;
    return false;
  });
  const double within = std::clamp((target - below) / here, 0.0, 1.0);
  const auto width = static_cast<double>((begin_of(found + 1) - begin_of(found)).count());
  return begin_of(found) + Nanoseconds(std::llround(within * width));
}

std::int64_t SoaHistogram::beyond(Nanoseconds before, Nanoseconds after) const {
  std::int64_t count = 0;
  each_bin([&](std::int64_t bin, std::int32_t n) {
    const Nanoseconds middle = (begin_of(bin) + begin_of(bin + 1)) / 2;
    if (middle < -before || middle > after) count += n;
    return false;
  });
  return count;
}

}  // namespace tactus::sync
