#include "thermal_node/display/lag.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

using tactus::thermal::Lag;

TEST_CASE("A slow display follows a step by the closed form, however time is cut") {
  const double response_s = GENERATE(0.05, 0.5, 10.0);
  const double dt_s = GENERATE(0.001, 0.02, 0.1);
  Lag lag(33);
  for (int i = 1; i <= 500; ++i)
    REQUIRE(lag.step(20, dt_s, response_s) == Approx(20 + 13 * std::exp(-i * dt_s / response_s)).margin(1e-9));
}

TEST_CASE("A slow display follows a ramp at a distance of rate times response") {
  Lag lag(0);
  double y = 0;
  for (int i = 1; i <= 2000; ++i) y = lag.step(2 * i * 0.01, 0.01, 0.5);
  // 2 K/s, 0.5 s; the ramp is a staircase whose mean runs half a step of 10 ms ahead.
  CHECK(2 * 20 - y == Approx(2 * (0.5 - 0.005)).epsilon(1e-3));
}

TEST_CASE("A display without a response is what it is told") {
  Lag lag(33);
  CHECK(lag.step(20, 0.02, 0) == 20);
  CHECK(lag.step(30, 0.02, 0) == 30);
}

TEST_CASE("A response begins where the display stands, and one that changes goes on from there") {
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

TEST_CASE("What is no number does not move a slow display, and is forgotten") {
  Lag lag(33);
  for (const double x : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    CHECK(lag.step(x, 0.02, 0.5) == 33);
    CHECK(lag.step(x, 0.02, 0) == 33);
  }
  CHECK(lag.step(20, -1, 0.5) == 33);
  CHECK(lag.step(20, 1e9, 0.5) == Approx(20));
}
