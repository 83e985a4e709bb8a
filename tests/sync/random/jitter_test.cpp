// Tests of the distributions and the correlation of jitter.
#include "sync/random/jitter.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>

#include "sync/random/keyed_random.h"

using namespace tactus::sync;

namespace {

std::vector<double> draws(const JitterDef& def, int n) {
  Jitter jitter(def);
  std::vector<double> out;
  for (int i = 0; i < n; ++i) out.push_back(to_seconds(jitter.next(uniform(5, static_cast<std::uint64_t>(i)))));
  return out;
}

// Largest distance of the empirical distribution from the expected one (Kolmogorov and Smirnov).
double distance(std::vector<double> x, const std::function<double(double)>& cdf) {
  std::sort(x.begin(), x.end());
  double worst = 0;
  for (std::size_t i = 0; i < x.size(); ++i)
    worst = std::max({worst, std::abs(cdf(x[i]) - static_cast<double>(i) / static_cast<double>(x.size())),
                      std::abs(cdf(x[i]) - static_cast<double>(i + 1) / static_cast<double>(x.size()))});
  return worst;
}

// 1.95 / sqrt(n) is exceeded once in a thousand (Smirnov 1948); rounding to a nanosecond is negligible.
double critical(int n) { return 1.95 / std::sqrt(n); }

double correlation(const std::vector<double>& x) {
  double mean = 0, square = 0, product = 0;
  for (const double v : x) mean += v / static_cast<double>(x.size());
  for (std::size_t i = 1; i < x.size(); ++i) {
    square += (x[i] - mean) * (x[i] - mean);
    product += (x[i] - mean) * (x[i - 1] - mean);
  }
  return product / square;
}

}  // namespace

TEST_CASE("Jitter has the specified distribution") {
  constexpr int kN = 20'000;
  CHECK(distance(draws({JitterShape::kUniform, 0.010}, kN),
                 [](double x) { return std::clamp((x + 0.010) / 0.020, 0.0, 1.0); }) < critical(kN));
  CHECK(distance(draws({JitterShape::kNormal, 0.003}, kN), [](double x) { return normal_cdf(x / 0.003); }) <
        critical(kN));
  const auto pareto = draws({JitterShape::kPareto, 0.002}, kN);
  const double scale = 0.002 * (kParetoIndex - 1);
  CHECK(distance(pareto, [&](double x) { return x <= 0 ? 0 : 1 - std::pow(1 + x / scale, -kParetoIndex); }) <
        critical(kN));
  CHECK(*std::min_element(pareto.begin(), pareto.end()) >= 0);
}

TEST_CASE("Correlated jitter has the specified distribution and autocorrelation") {
  constexpr int kN = 100'000;
  for (const double rho : {0.5, 0.9}) {
    const auto normal = draws({JitterShape::kNormal, 0.003, rho, {}}, kN);
    // The standard error of a correlation is at most 1/sqrt(n).
    CHECK(std::abs(correlation(normal) - rho) < 5 / std::sqrt(kN));
    // The number of independent draws is smaller: n (1 - rho) / (1 + rho).
    const double independent = kN * (1 - rho) / (1 + rho);
    CHECK(distance(normal, [](double x) { return normal_cdf(x / 0.003); }) <
          critical(static_cast<int>(independent)));
    // Rank correlation of uniforms over a Gaussian copula: 6/pi asin(rho/2) (Pearson 1907).
    const auto uniforms = draws({JitterShape::kUniform, 0.003, rho, {}}, kN);
    CHECK(std::abs(correlation(uniforms) - 6 / M_PI * std::asin(rho / 2)) < 5 / std::sqrt(kN));
  }
}

TEST_CASE("A trace is repeated cyclically") {
  const auto x = draws({JitterShape::kTrace, 0, 0, {0.001, 0.005, 0.002}}, 7);
  CHECK(x == std::vector<double>{0.001, 0.005, 0.002, 0.001, 0.005, 0.002, 0.001});
  CHECK(draws({JitterShape::kTrace, 0, 0, {}}, 2) == std::vector<double>{0, 0});
}
