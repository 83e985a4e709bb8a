// Tests of linear and logarithmic quantisation and of the low-pass filter.
#include "sync/degradation/quantise.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

using namespace tactus::sync;

TEST_CASE("Linear quantisation has an error of at most half a step and few levels") {
  const QuantiseDef def{Quantity::kForce, 0.1, 0, 0};
  std::mt19937 random(3);
  std::uniform_real_distribution<double> value(-5, 5);
  for (int i = 0; i < 1000; ++i) {
    const double x = value(random), q = quantised(def, x);
    CHECK(std::abs(q - x) <= 0.05 + 1e-12);
    CHECK(std::abs(q / 0.1 - std::round(q / 0.1)) < 1e-9);
    CHECK(quantised(def, q) == Approx(q));
  }
  CHECK(quantised(def, 0.04) == 0);
}

TEST_CASE("Logarithmic quantisation has a bounded relative error") {
  const QuantiseDef def{Quantity::kForce, 0, 1.1, 0.01};
  std::mt19937 random(4);
  std::uniform_real_distribution<double> exponent(-2, 2);
  for (int i = 0; i < 1000; ++i) {
    const double x = std::pow(10, exponent(random)), q = quantised(def, x);
    CHECK(std::abs(std::log(q / x)) <= std::log(1.1) / 2 + 1e-12);
    CHECK(quantised(def, -x) == -q);
  }
  CHECK(quantised(def, 0.009) == 0);
  CHECK(quantised(def, 0.0099) == Approx(0.01));
  CHECK(quantised(def, 0) == 0);
}

TEST_CASE("The step response of the low-pass is 1 - exp(-2 pi f t)") {
  double y = 0;
  for (int i = 0; i < 100; ++i) y = lowpassed(y, 1, 5, 0.001);
  CHECK(y == Approx(1 - std::exp(-2 * M_PI * 5 * 0.1)).epsilon(1e-12));
}
