// Tests of random numbers by key and of the normal quantile.
#include "sync/random/keyed_random.h"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>

using namespace tactus::sync;

TEST_CASE("normal_quantile() is the inverse of the normal distribution") {
  // The published accuracy is 1e-16 relative; the distribution itself, through erfc, is good to about 1e-15 of p.
  for (const double p : {1e-12, 1e-8, 1e-4, 0.01, 0.074, 0.0751, 0.3, 0.5, 0.7, 0.9249, 0.926, 0.99, 0.9999})
    CHECK(normal_cdf(normal_quantile(p)) == Approx(p).epsilon(1e-12));
  CHECK(normal_quantile(0.5) == 0);
  // Abramowitz and Stegun 1964, table 26.5.
  CHECK(normal_quantile(0.975) == Approx(1.959963984540054).epsilon(1e-14));
}

TEST_CASE("A draw depends only on seed and key and is uniformly distributed") {
  CHECK(uniform(7, 42) == uniform(7, 42));
  CHECK(uniform(7, 42) != uniform(8, 42));
  // Keys as in use: ids that count up. Chi-square over 100 cells: mean 99, standard deviation sqrt(198) = 14.1.
  for (const std::uint64_t seed : {0ull, 1ull, 0xffffffffffffffffull}) {
    std::array<int, 100> cells{};
    constexpr int kDraws = 200'000;
    double previous = 0.5, correlation = 0;
    for (std::uint64_t key = 0; key < kDraws; ++key) {
      const double u = uniform(seed, (0x123456ull << 40) + key);
      REQUIRE((u > 0 && u < 1));
      ++cells[static_cast<std::size_t>(u * 100)];
      correlation += (u - 0.5) * (previous - 0.5);
      previous = u;
    }
    double chi2 = 0;
    for (const int n : cells) chi2 += (n - kDraws / 100.0) * (n - kDraws / 100.0) / (kDraws / 100.0);
    CHECK(chi2 < 99 + 5 * 14.1);
    // Correlation of neighbours: standard error 1/12/sqrt(n).
    CHECK(std::abs(correlation / kDraws) < 5 / 12.0 / std::sqrt(kDraws));
  }
}
