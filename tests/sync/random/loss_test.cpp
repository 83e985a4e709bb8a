// Tests of independent and bursty losses.
#include "sync/random/loss.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "sync/random/keyed_random.h"

using namespace tactus::sync;

namespace {

struct Observed {
  double share, mean_burst;
  int bursts;
};

Observed run(const LossDef& def, int n, std::uint64_t seed) {
  Loss loss(def);
  int lost = 0, bursts = 0;
  bool before = false;
  for (int i = 0; i < n; ++i) {
    const bool now = loss.lose(uniform(seed, static_cast<std::uint64_t>(i)));
    lost += now;
    bursts += now && !before;
    before = now;
  }
  return {static_cast<double>(lost) / n, bursts > 0 ? static_cast<double>(lost) / bursts : 0, bursts};
}

}  // namespace

TEST_CASE("Independent loss has the specified share") {
  constexpr int kN = 100'000;
  for (const double share : {0.0, 0.001, 0.05, 0.3, 0.9, 1.0}) {
    const Observed o = run({share, 0}, kN, 3);
    // Binomial, five standard deviations.
    CHECK(std::abs(o.share - share) <= 5 * std::sqrt(share * (1 - share) / kN));
    // Runs of independent losses are geometric with mean 1 / (1 - share).
    if (share > 0.01 && share < 1) CHECK(o.mean_burst == Approx(1 / (1 - share)).epsilon(0.05));
  }
}

TEST_CASE("Bursty loss has the specified share and mean burst") {
  constexpr int kN = 400'000;
  for (const double share : {0.01, 0.05, 0.3, 0.7})
    for (const double burst : {3.0, 10.0, 50.0}) {
      const Observed o = run({share, burst}, kN, 11);
      INFO(share << " in bursts of " << burst);
      // Bursts are geometric with mean b: standard deviation sqrt(b (b - 1)), over the bursts counted.
      CHECK(std::abs(o.mean_burst - burst) <= 5 * std::sqrt(burst * (burst - 1) / o.bursts));
      // The share of a two-state chain: binomial, with the variance enlarged by (1 + r) / (1 - r), where r = 1 - p(good to bad) - p(bad to
      // good) is the chain's second eigenvalue.
      const double r = 1 - share / (burst * (1 - share)) - 1 / burst;
      CHECK(std::abs(o.share - share) <= 5 * std::sqrt(share * (1 - share) / kN * (1 + r) / (1 - r)));
    }
}

TEST_CASE("An impossible loss is rejected") {
  CHECK_THROWS_WITH(Loss({1.5, 0}), Catch::Contains("0% to 100%"));
  CHECK_THROWS_WITH(Loss({-0.1, 0}), Catch::Contains("0% to 100%"));
  CHECK_THROWS_WITH(Loss({0.1, 0.5}), Catch::Contains("at least 1"));
  CHECK_THROWS_WITH(Loss({0.9, 2}), Catch::Contains("9.0"));
  CHECK_NOTHROW(Loss({0.9, 9.001}));
}

TEST_CASE("Total loss drops all messages, with and without bursts") {
  CHECK(run({1, 0}, 1000, 1).share == 1);
  CHECK(run({1, 5}, 1000, 1).share == 1);
  CHECK(run({0, 5}, 1000, 1).share == 0);
}
