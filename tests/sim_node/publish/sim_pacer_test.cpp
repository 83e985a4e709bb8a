#include "sim_node/publish/sim_pacer.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/times.h"

using namespace tactus;
using namespace tactus::sim;
using tactus::test::kMs;

namespace {

constexpr std::int64_t kStart = 7'000'000'000'000;

}  // namespace

TEST_CASE("A loop without delays has an exact map") {
  SimPacer pacer;
  for (int i = 1; i < 3000; ++i) {
    const sync::TimeMap map = pacer.tick(sync::sim_time(i * kMs), sync::host_time(kStart + i * kMs));
    CHECK(map.rate == 1);
    CHECK(sync::to_ns(map.host) - sync::to_ns(map.sim) == kStart);
  }
  CHECK(pacer.realtime_factor() == Approx(1));
}

TEST_CASE("A missed tick slews the map instead of stepping it") {
  SimPacer pacer;
  std::int64_t late = 0, last = 0;
  for (int i = 1; i < 500; ++i) {
    if (i == 100) late = kMs;
    const sync::TimeMap map = pacer.tick(sync::sim_time(i * kMs), sync::host_time(kStart + late + i * kMs));
    const std::int64_t offset = sync::to_ns(map.host) - sync::to_ns(map.sim);
    if (i > 1) CHECK(std::abs(offset - last) <= 50'000);  // 5 % of a tick
    CHECK(map.rate > 0.94);
    last = offset;
  }
  CHECK(last == Approx(kStart + kMs).margin(10));
}

TEST_CASE("A simulation at half speed publishes its rate and an accurate map") {
  SimPacer pacer;
  sync::TimeMap map;
  for (int i = 1; i <= 3000; ++i) map = pacer.tick(sync::sim_time(i * kMs), sync::host_time(kStart + 2 * i * kMs));
  CHECK(map.rate == Approx(0.5).epsilon(1e-6));
  CHECK(pacer.realtime_factor() == Approx(0.5));
  // The lag is at most the time constant, 20 ms of simulated time.
  CHECK(std::abs(sync::to_ns(map.host) - (kStart + 6000 * kMs)) <= 20 * kMs);
}

TEST_CASE("The map is monotone, also across a stop") {
  SimPacer pacer;
  std::int64_t pause = 0, last = 0;
  for (int i = 1; i < 2000; ++i) {
    if (i == 1000) pause = 2'000 * kMs;
    const sync::TimeMap map = pacer.tick(sync::sim_time(i * kMs), sync::host_time(kStart + pause + i * kMs));
    CHECK(sync::to_ns(map.host) > last);
    CHECK(map.rate > 0);
    last = sync::to_ns(map.host);
  }
}

TEST_CASE("A paused world has a constant map and a new one after the pause") {
  SimPacer pacer;
  sync::TimeMap map{};
  for (int i = 1; i < 100; ++i) map = pacer.tick(sync::sim_time(i * kMs), sync::host_time(kStart + i * kMs));
  const sync::TimeMap before = map;
  for (int i = 100; i < 5000; ++i) {
    map = pacer.hold(before.sim, sync::host_time(kStart + i * kMs));
    CHECK(map.rate == 0);
    CHECK(map.sim == before.sim);
    CHECK(map.host == before.host);  // events just before the pause keep their instants
  }
  CHECK(pacer.realtime_factor() == 0);
  map = pacer.tick(before.sim + sync::Nanoseconds(kMs), sync::host_time(kStart + 5000 * kMs));
  CHECK(map.rate == 1);
  CHECK(sync::to_ns(map.host) == kStart + 5000 * kMs);
}

TEST_CASE("A world that starts paused has a map") {
  SimPacer pacer;
  CHECK(sync::to_ns(pacer.hold(sync::sim_time(5), sync::host_time(kStart)).host) == kStart);
  CHECK(pacer.hold(sync::sim_time(5), sync::host_time(kStart + kMs)).rate == 0);
}
