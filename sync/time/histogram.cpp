#include "sync/time/histogram.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace tactus::sync {
namespace {
constexpr double kBinsPerOctave = 4;
double lower_edge_ns(int bin) { return bin == 0 ? 0 : 1000 * std::exp2((bin - 1) / kBinsPerOctave); }
double upper_edge_ns(int bin) { return 1000 * std::exp2(bin / kBinsPerOctave); }
}  // namespace

void Histogram::add(Nanoseconds duration) {
  const double us = static_cast<double>(duration.count()) * 1e-3;
  const int bin = us < 1 ? 0 : 1 + static_cast<int>(kBinsPerOctave * std::log2(us));
  ++bins_[static_cast<std::size_t>(std::min(bin, kBins - 1))];
  max_ = std::max(max_, duration);
}

std::int64_t Histogram::count() const { return std::accumulate(bins_.begin(), bins_.end(), std::int64_t{0}); }

Nanoseconds Histogram::quantile(double q) const {
  const double target = q * static_cast<double>(count());
  double below = 0;
  for (int i = 0; i < kBins; ++i) {
    const double here = bins_[static_cast<std::size_t>(i)];
    if (here > 0 && below + here >= target) {
      const double within = std::max(0.0, (target - below) / here);
      const double ns = lower_edge_ns(i) + within * (upper_edge_ns(i) - lower_edge_ns(i));
      return std::min(max_, Nanoseconds(std::llround(ns)));
    }
    below += here;
  }
  return max_;
}

void Histogram::merge(const Histogram& other) {
  for (std::size_t i = 0; i < bins_.size(); ++i) bins_[i] += other.bins_[i];
  max_ = std::max(max_, other.max_);
}

histogram_t Histogram::to_message() const {
  histogram_t m{};
  m.max_ns = max_.count();
  const auto last = std::find_if(bins_.rbegin(), bins_.rend(), [](int n) { return n > 0; });
  m.bins.assign(bins_.begin(), last.base());
  m.bin_count = static_cast<std::int32_t>(m.bins.size());
  return m;
}

Histogram Histogram::from_message(const histogram_t& m) {
  Histogram h;
  std::copy_n(m.bins.begin(), std::min<std::size_t>(m.bins.size(), kBins), h.bins_.begin());
  h.max_ = Nanoseconds(m.max_ns);
  return h;
}

}  // namespace tactus::sync
