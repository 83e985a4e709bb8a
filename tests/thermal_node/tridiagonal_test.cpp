#include "thermal_node/tridiagonal.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <vector>

TEST_CASE("A tridiagonal system is solved: the equations hold with what comes out") {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (std::size_t n = 1; n <= 60; ++n) {
    std::vector<double> lower(n), centre(n), upper(n), right(n), scratch(n);
    for (std::size_t i = 0; i < n; ++i) {
      lower[i] = uniform(random), upper[i] = uniform(random), right[i] = 10 * uniform(random);
      centre[i] = (std::abs(lower[i]) + std::abs(upper[i]) + 0.1) * (i % 2 ? 1 : -1);  // diagonally dominant
    }
    std::vector<double> x = right;
    tactus::thermal::solve_tridiagonal(lower, centre, upper, x, scratch);
    for (std::size_t i = 0; i < n; ++i) {
      const double left =
          centre[i] * x[i] + (i > 0 ? lower[i] * x[i - 1] : 0) + (i + 1 < n ? upper[i] * x[i + 1] : 0);
      REQUIRE(left == Approx(right[i]).margin(1e-10));
    }
  }
}
