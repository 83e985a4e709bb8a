// Tests of the aligners that choose a playout delay.
#include "sync/playout/aligner.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <random>
#include <vector>

#include "tests/times.h"

using namespace tactus::sync;
using tactus::test::kMillisecond;

namespace {

// Delays of 20 ms with an exponential tail of 5 ms: a network with queues.
std::vector<Nanoseconds> tailed(int n, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::exponential_distribution<double> tail(1 / 5.0);
  std::vector<Nanoseconds> needed;
  for (int i = 0; i < n; ++i) needed.push_back(Nanoseconds(static_cast<std::int64_t>((20 + tail(random)) * 1e6)));
  return needed;
}

// Share of events with more delay than the aligner had set for them, after a warm-up.
double late_share(Aligner& aligner, const std::vector<Nanoseconds>& trace, int learn = 200) {
  int late = 0, n = 0;
  for (const Nanoseconds needed : trace) {
    if (++n > learn && needed > aligner.delay()) ++late;
    aligner.add(needed);
  }
  return double(late) / (n - learn);
}

}  // namespace

TEST_CASE("The quantile aligner estimates a constant latency exactly") {
  const auto aligner = make_aligner(AlignerKind::kQuantile, 0 * kMillisecond);
  for (int i = 0; i < 500; ++i) aligner->add(30 * kMillisecond);
  CHECK(aligner->delay() == 30 * kMillisecond);
}

TEST_CASE("The fixed aligner returns its delay regardless of the measured need") {
  const auto aligner = make_aligner(AlignerKind::kFixed, 40 * kMillisecond);
  aligner->add(90 * kMillisecond);
  CHECK(aligner->delay() == 40 * kMillisecond);
}

TEST_CASE("The quantile aligner is late for 5 % of the events") {
  const auto aligner = make_aligner(AlignerKind::kQuantile, 0 * kMillisecond);
  // 20,000 events, but the quantile of 128 is itself uncertain: its rank has the mean 0.95 (order statistics: 122/129).
  const double late = late_share(*aligner, tailed(20'000));
  CHECK(late > 0.040);
  CHECK(late < 0.066);
}

TEST_CASE("One very late event does not change the quantile") {
  const auto aligner = make_aligner(AlignerKind::kQuantile, 0 * kMillisecond);
  for (int i = 0; i < 100; ++i) aligner->add(20 * kMillisecond);
  aligner->add(500 * kMillisecond);
  CHECK(aligner->delay() == 20 * kMillisecond);
}

TEST_CASE("An aligner is selected by its name, and an unknown name is rejected") {
  for (const char* name : {"fixed", "quantile"})
    CHECK(name_of(parse_aligner(name)) == std::string(name));
  for (const char* name : {"average", "virtual-time"}) CHECK_THROWS_AS(parse_aligner(name), std::invalid_argument);
  CHECK_THROWS_AS(parse_aligner("median"), std::invalid_argument);
}
