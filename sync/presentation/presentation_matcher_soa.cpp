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
  ++bins_[static_cast<std::size_t>(bin)];
  first_ = std::min(first_, bin), last_ = std::max(last_, bin);
  ++count_;
  uncertainty_ = std::max(uncertainty_, uncertainty);
}

Nanoseconds SoaHistogram::quantile(double q) const {
  if (count_ == 0) return Nanoseconds(0);
  const double target = q * static_cast<double>(count_);
  double below = 0;
  std::int64_t bin = first_;
  for (; bin < last_; ++bin) {
    const double here = bins_[static_cast<std::size_t>(bin)];
    if (here > 0 && below + here >= target) break;
    below += here;
  }
  const double here = std::max(1, bins_[static_cast<std::size_t>(bin)]);
  const double within = std::clamp((target - below) / here, 0.0, 1.0);
  const auto width = static_cast<double>((begin_of(bin + 1) - begin_of(bin)).count());
  return begin_of(bin) + Nanoseconds(std::llround(within * width));
}

std::int64_t SoaHistogram::beyond(Nanoseconds before, Nanoseconds after) const {
  std::int64_t count = 0;
  for (std::int64_t bin = first_; bin <= last_; ++bin) {
    const Nanoseconds middle = (begin_of(bin) + begin_of(bin + 1)) / 2;
    if (middle < -before || middle > after) count += bins_[static_cast<std::size_t>(bin)];
  }
  return count;
}

}  // namespace tactus::sync
