#include "scripts/simulated_player/observer/sobol.h"

#include <catch2/catch.hpp>
#include <set>
#include <stdexcept>
#include <vector>

namespace tactus::observer {

TEST_CASE("Sobol points equal those of an independent generator with the direction numbers of Joe and Kuo") {
  // scipy.stats.qmc.Sobol(40, scramble=False), points 5 and 7, first ten coordinates.
  const double fifth[]{0.875, 0.875, 0.125, 0.375, 0.875, 0.625, 0.875, 0.375, 0.375, 0.125};
  const double seventh[]{0.125, 0.625, 0.375, 0.125, 0.125, 0.375, 0.625, 0.625, 0.625, 0.875};
  const auto a = sobol_point(5, 40), b = sobol_point(7, 40);
  for (std::size_t i = 0; i < 10; ++i) {
    CHECK(a[i] == fifth[i]);
    CHECK(b[i] == seventh[i]);
  }
  CHECK(a[39] == 0.375);
  CHECK(b[39] == 0.125);
}

TEST_CASE("The first 2^m scrambled Sobol points visit each of 2^m intervals of every coordinate once") {
  for (std::uint64_t seed : {1, 2, 3}) {
    std::vector<std::set<int>> intervals(kMaxSobolDimensions);
    for (std::uint32_t i = 0; i < 128; ++i) {
      const auto point = scrambled_sobol_point(i, kMaxSobolDimensions, seed);
      for (std::size_t dimension = 0; dimension < point.size(); ++dimension) {
        REQUIRE(point[dimension] > 0);
        REQUIRE(point[dimension] < 1);
        intervals[dimension].insert(static_cast<int>(point[dimension] * 128));
      }
    }
    for (const auto& visited : intervals) CHECK(visited.size() == 128);
  }
}

TEST_CASE("Sobol points are refused outside the stored dimensions") {
  CHECK_THROWS_AS(sobol_point(0, 0), std::invalid_argument);
  CHECK_THROWS_AS(scrambled_sobol_point(0, kMaxSobolDimensions + 1, 1), std::invalid_argument);
}

}  // namespace tactus::observer
