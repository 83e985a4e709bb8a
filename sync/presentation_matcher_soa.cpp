#include "sync/presentation_matcher_soa.h"

#include <algorithm>
#include <cmath>

namespace tactus::sync {

void SoaHistogram::add(Nanoseconds soa, Nanoseconds uncertainty) {
  const Nanoseconds inside = std::clamp(soa, -kRange, kRange - Nanoseconds(1));
  ++bins_[static_cast<std::size_t>((inside + kRange) / kBin)];
  ++count_;
  uncertainty_ = std::max(uncertainty_, uncertainty);
}

Nanoseconds SoaHistogram::quantile(double q) const {
  if (count_ == 0) return Nanoseconds(0);
  const double target = q * static_cast<double>(count_);
  double below = 0;
  std::int64_t bin = 0;
  for (; bin < kBins - 1; ++bin) {
    const double here = bins_[static_cast<std::size_t>(bin)];
    if (here > 0 && below + here >= target) break;
    below += here;
  }
  const double here = std::max(1, bins_[static_cast<std::size_t>(bin)]);
  const double within = std::clamp((target - below) / here, 0.0, 1.0);
  return bin * kBin - kRange + Nanoseconds(std::llround(within * static_cast<double>(kBin.count())));
}

std::int64_t SoaHistogram::beyond(Nanoseconds before, Nanoseconds after) const {
  std::int64_t count = 0;
  for (std::int64_t bin = 0; bin < kBins; ++bin) {
    const Nanoseconds middle = bin * kBin - kRange + kBin / 2;
    if (middle < -before || middle > after) count += bins_[static_cast<std::size_t>(bin)];
  }
  return count;
}

}  // namespace tactus::sync
