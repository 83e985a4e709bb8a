// Tests of the SOA statistics of the presentation matcher.
#include "sync/presentation/presentation_matcher_soa.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <random>

using namespace tactus::sync;

TEST_CASE("Quantiles of the SOA histogram match the sorted list within one bin") {
  std::mt19937 random(1);
  for (int round = 0; round < 20; ++round) {
    SoaHistogram histogram;
    std::vector<std::int64_t> list;
    std::normal_distribution<> ns(round * 1e7 - 5e7, 1e6 * (1 + round));
    for (int i = 0; i < 1001; ++i) {
      list.push_back(static_cast<std::int64_t>(ns(random)));
      histogram.add(Nanoseconds(list.back()), Nanoseconds(0));
    }
    std::sort(list.begin(), list.end());
    for (double q : {0.05, 0.5, 0.95}) {
      // The histogram places the i-th of n values at i / n, the list at (i - 1) / (n - 1): at most one neighbour apart.
      const auto i = static_cast<std::size_t>(q * 1000);
      const std::int64_t bin = SoaHistogram::kBin.count();
      CHECK(histogram.quantile(q).count() >= list[i > 0 ? i - 1 : 0] - bin);
      CHECK(histogram.quantile(q).count() <= list[std::min<std::size_t>(i + 1, 1000)] + bin);
    }
  }
}

TEST_CASE("An empty SOA histogram has zero quantiles, and values beyond the range count at its edge") {
  SoaHistogram histogram;
  CHECK(histogram.quantile(0.5) == Nanoseconds(0));
  histogram.add(Nanoseconds(-900'000'000'000), Nanoseconds(0));
  CHECK(histogram.quantile(0.5) <= -SoaHistogram::kWideRange + SoaHistogram::kWideBin);
  for (int i = 0; i < 3; ++i) histogram.add(Nanoseconds(900'000'000'000), Nanoseconds(0));
  CHECK(histogram.quantile(0.9) >= SoaHistogram::kWideRange - SoaHistogram::kWideBin);
  CHECK(histogram.count() == 4);
}

TEST_CASE("Asynchronies of many seconds are accurate to 10 ms") {
  for (const std::int64_t ms : {-60'000, -3'026, -2'001, -1'999, 1'999, 2'001, 3'026, 60'000, 121'000}) {
    SoaHistogram histogram;
    for (int i = 0; i < 5; ++i) histogram.add(Nanoseconds(ms * 1'000'000), Nanoseconds(0));
    const Nanoseconds wide = std::abs(ms) < 2000 ? SoaHistogram::kBin : SoaHistogram::kWideBin;
    CHECK(std::abs(histogram.quantile(0.5).count() - ms * 1'000'000) <= wide.count());
    CHECK(histogram.beyond(Nanoseconds(0), Nanoseconds(0)) == 5);
    CHECK(histogram.beyond(SoaHistogram::kWideRange, SoaHistogram::kWideRange) == 0);
  }
}
