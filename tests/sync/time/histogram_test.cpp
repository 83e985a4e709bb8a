// Tests of the duration histogram.
#include "sync/time/histogram.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <tactus/histogram_t.hpp>
#include <vector>

using namespace tactus;
using sync::Histogram;
using sync::Nanoseconds;

namespace {

// Values over six decades, distributed like durations.
std::vector<std::int64_t> durations(unsigned seed, int count) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> decade(2, 8.8);
  std::vector<std::int64_t> values;
  for (int i = 0; i < count; ++i) values.push_back(static_cast<std::int64_t>(std::pow(10, decade(random))));
  return values;
}

Histogram of(const std::vector<std::int64_t>& values) {
  Histogram h;
  for (const std::int64_t v : values) h.add(Nanoseconds(v));
  return h;
}

}  // namespace

TEST_CASE("A quantile is within one bin of the true one") {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    std::vector<std::int64_t> values = durations(seed, 1000);
    const Histogram h = of(values);
    std::sort(values.begin(), values.end());
    for (const double q : {0.01, 0.05, 0.5, 0.95, 0.99, 0.999}) {
      const double truth = static_cast<double>(values[static_cast<std::size_t>(std::ceil(q * 1000)) - 1]);
      const double found = static_cast<double>(h.quantile(q).count());
      INFO("q = " << q << ", true " << truth << " ns, found " << found << " ns");
      // A bin is a quarter of an octave, the lowest one 1 us wide.
      CHECK(found <= std::max(1000.0, truth * std::exp2(0.25)) * (1 + 1e-9));
      CHECK(found >= (truth < 1000 ? 0 : truth * std::exp2(-0.25) * (1 - 1e-9)));
    }
  }
}

TEST_CASE("Quantiles increase with q and never exceed the largest value") {
  const Histogram h = of(durations(5, 500));
  Nanoseconds before{0};
  for (double q = 0; q <= 1.0001; q += 0.01) {
    const Nanoseconds here = h.quantile(std::min(q, 1.0));
    REQUIRE(here >= before);
    REQUIRE(here <= h.max());
    before = here;
  }
  CHECK(h.quantile(1) == h.max());
}

TEST_CASE("An empty histogram returns zero") {
  CHECK(Histogram().quantile(0.5) == Nanoseconds(0));
  CHECK(Histogram().count() == 0);
  CHECK(Histogram().to_message().bin_count == 0);
}

TEST_CASE("Zero, negative and very large durations have a bin") {
  Histogram h;
  for (const std::int64_t v :
       {std::int64_t{0}, std::int64_t{-5}, std::int64_t{999}, std::int64_t{1000}, std::int64_t{1} << 62})
    h.add(Nanoseconds(v));
  CHECK(h.count() == 5);
  CHECK(h.max() == Nanoseconds(std::int64_t{1} << 62));
}

TEST_CASE("Merging histograms equals adding all values to one") {
  const auto a = durations(1, 300), b = durations(2, 400);
  Histogram merged = of(a);
  merged.merge(of(b));
  auto both = a;
  both.insert(both.end(), b.begin(), b.end());
  CHECK(merged.to_message().bins == of(both).to_message().bins);
  CHECK(merged.max() == of(both).max());
}

TEST_CASE("A histogram is unchanged after encoding as a message") {
  const Histogram h = of(durations(3, 300));
  const Histogram back = Histogram::from_message(h.to_message());
  CHECK(back.to_message().bins == h.to_message().bins);
  CHECK(back.max() == h.max());
  CHECK(back.count() == h.count());
  SECTION("a message with more bins than the receiver is accepted") {
    histogram_t m{};
    m.bins.assign(500, 1);
    m.bin_count = 500;
    CHECK(Histogram::from_message(m).count() == Histogram::kBins);
  }
}
