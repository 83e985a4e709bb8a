// Tests of time types and the map of simulated time.
#include "sync/time/time.h"

#include <catch2/catch.hpp>
#include <random>
#include <type_traits>

using namespace tactus::sync;
using namespace std::chrono_literals;

template <class A, class B>
concept Subtractable = requires(A a, B b) {
  a - b;
};

TEST_CASE("Simulated and host time cannot be mixed") {
  STATIC_REQUIRE(Subtractable<HostTime, HostTime>);
  STATIC_REQUIRE(Subtractable<SimTime, SimTime>);
  STATIC_REQUIRE_FALSE(Subtractable<HostTime, SimTime>);
  STATIC_REQUIRE_FALSE(Subtractable<SimTime, HostTime>);
  STATIC_REQUIRE_FALSE(std::is_convertible_v<SimTime, HostTime>);
  STATIC_REQUIRE_FALSE(std::is_convertible_v<std::int64_t, HostTime>);
}

TEST_CASE("A time map at rate 1 is exact to 1 ns in both directions, also after years") {
  std::mt19937_64 random(1);
  std::uniform_int_distribution<std::int64_t> ns(0, std::int64_t{1} << 60);
  for (int i = 0; i < 1000; ++i) {
    const TimeMap map{sim_time(ns(random)), host_time(ns(random)), 1};
    const HostTime h = host_time(ns(random));
    REQUIRE(map.to_host(map.to_sim(h)) == h);
    REQUIRE(map.to_sim(h) - map.sim == h - map.host);
  }
}

TEST_CASE("A time map at other rates is inverted within rounding") {
  std::mt19937_64 random(2);
  std::uniform_int_distribution<std::int64_t> near(-1'000'000'000, 1'000'000'000);
  for (const double rate : {0.01, 0.3, 0.999, 1.7, 10.0}) {
    for (int i = 0; i < 200; ++i) {
      const TimeMap map{sim_time(near(random) + 5'000'000'000), host_time(near(random) + 5'000'000'000), rate};
      const HostTime h = map.host + Nanoseconds(near(random));
      // One nanosecond of simulated time is 1/rate of host time; two roundings.
      const double error_ns = std::abs(static_cast<double>((map.to_host(map.to_sim(h)) - h).count()));
      REQUIRE(error_ns <= 1 + 1 / rate);
    }
  }
}

TEST_CASE("A paused world has constant simulated time and one host time") {
  const TimeMap map{sim_time(42), host_time(1000), 0};
  CHECK(map.to_sim(host_time(0)) == sim_time(42));
  CHECK(map.to_sim(host_time(1'000'000'000)) == sim_time(42));
  CHECK(map.to_host(sim_time(42)) == host_time(1000));
  CHECK(map.to_host(sim_time(7)) == host_time(1000));
}

TEST_CASE("Seconds and nanoseconds are converted in both directions") {
  CHECK(from_seconds(1.5) == 1500ms);
  CHECK(to_seconds(250ms) == Approx(0.25));
  CHECK(to_ns(host_time(-5)) == -5);
}
