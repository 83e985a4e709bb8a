#include "thermal_node/display/lag.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

using tactus::thermal::Lag;

TEST_CASE("A lag follows a step by the closed form at any time step") {
  const double response_s = GENERATE(0.05, 0.5, 10.0);
  const double dt_s = GENERATE(0.001, 0.02, 0.1);
  Lag lag(33);
  for (int i = 1; i <= 500; ++i)
    REQUIRE(lag.step(20, dt_s, response_s) == Approx(20 + 13 * std::exp(-i * dt_s / response_s)).margin(1e-9));
}

TEST_CASE("A lag follows a ramp at a distance of rate times response") {
  Lag lag(0);
  double y = 0;
  for (int i = 1; i <= 2000; ++i) y = lag.step(2 * i * 0.01, 0.01, 0.5);
  // 2 K/s, 0.5 s; the ramp is a staircase whose mean runs half a step of 10 ms ahead.
  CHECK(2 * 20 - y == Approx(2 * (0.5 - 0.005)).epsilon(1e-3));
}

TEST_CASE("A lag with response 0 returns its input") {
  Lag lag(33);
  CHECK(lag.step(20, 0.02, 0) == 20);
  CHECK(lag.step(30, 0.02, 0) == 30);
}

TEST_CASE("A lag continues from its value when the response changes") {
  Lag lag(33);
  CHECK(lag.step(25, 0.02, 0) == 25);
  double last = 25;
  for (const double response_s : {1.0, 1.0, 0.2, 5.0}) {
    const double next = lag.step(20, 0.02, response_s);
    CHECK(last - next > 0);
    CHECK(last - next <= 5 * (1 - std::exp(-0.02 / response_s)) + 1e-12);
    last = next;
  }
  lag.set(40);
  CHECK(lag.step(20, 0.02, 1e6) == Approx(40).margin(1e-3));
}

TEST_CASE("An input that is not finite leaves a lag unchanged") {
  Lag lag(33);
  for (const double x : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    CHECK(lag.step(x, 0.02, 0.5) == 33);
    CHECK(lag.step(x, 0.02, 0) == 33);
  }
  CHECK(lag.step(20, -1, 0.5) == 33);
  CHECK(lag.step(20, 1e9, 0.5) == Approx(20));
}
