// Tests of the aligners that choose a playout delay.
#include "sync/playout/aligner.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <random>
#include <vector>

using namespace tactus::sync;

namespace {

constexpr Nanoseconds kMs{1'000'000};

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

TEST_CASE("Every aligner gives what a constant latency needs, and hardly more") {
  const auto kind = GENERATE(AlignerKind::kQuantile, AlignerKind::kMovingAverage, AlignerKind::kVirtualTime);
  const auto aligner = make_aligner(kind, 0 * kMs);
  for (int i = 0; i < 500; ++i) aligner->add(30 * kMs);
  CHECK(aligner->delay() >= 30 * kMs);
  CHECK(aligner->delay() <= 32 * kMs);
}

TEST_CASE("A fixed aligner gives its delay, whatever is needed") {
  const auto aligner = make_aligner(AlignerKind::kFixed, 40 * kMs);
  aligner->add(90 * kMs);
  CHECK(aligner->delay() == 40 * kMs);
}

TEST_CASE("The quantile aligner is late for one event in twenty") {
  const auto aligner = make_aligner(AlignerKind::kQuantile, 0 * kMs);
  // 20,000 events, but the quantile of 128 is itself uncertain: its rank has the mean 0.95 (order statistics: 122/129).
  const double late = late_share(*aligner, tailed(20'000));
  CHECK(late > 0.040);
  CHECK(late < 0.066);
}

TEST_CASE("Mean and four deviations are late for less than 3 % of an exponential tail") {
  // Mean 5, mean deviation 10/e = 3.68 ms of that tail: exp(-19.7/5) = 1.9 % lies 19.7 ms beyond its beginning. The averages of 16 events
  // fluctuate.
  const auto aligner = make_aligner(AlignerKind::kMovingAverage, 0 * kMs);
  const double late = late_share(*aligner, tailed(20'000));
  CHECK(late > 0.005);
  CHECK(late < 0.045);
}

TEST_CASE("Virtual time follows a step up within a few events, and down slowly") {
  const auto aligner = make_aligner(AlignerKind::kVirtualTime, 0 * kMs);
  for (int i = 0; i < 50; ++i) aligner->add(20 * kMs);
  for (int i = 0; i < 5; ++i) aligner->add(60 * kMs);
  CHECK(aligner->delay() >= 60 * kMs);
  const Nanoseconds up = aligner->delay();
  for (int i = 0; i < 64; ++i) aligner->add(20 * kMs);  // two runs; in the first, one event did not fit
  CHECK(aligner->delay() < up);
  CHECK(aligner->delay() >= up - 2 * kMs);
  for (int i = 0; i < 2000; ++i) aligner->add(20 * kMs);
  CHECK(aligner->delay() <= 23 * kMs);
}

TEST_CASE("One event that came very late moves the quantile by nothing") {
  const auto aligner = make_aligner(AlignerKind::kQuantile, 0 * kMs);
  for (int i = 0; i < 100; ++i) aligner->add(20 * kMs);
  aligner->add(500 * kMs);
  CHECK(aligner->delay() == 20 * kMs);
}

TEST_CASE("Aligners are known by name, and no others") {
  for (const char* name : {"fixed", "quantile", "average", "virtual-time"})
    CHECK(name_of(parse_aligner(name)) == std::string(name));
  CHECK_THROWS_AS(parse_aligner("median"), std::invalid_argument);
}
