// Tests of the maps between the clocks of several hosts.
#include "sync/clocks/clock_maps.h"

#include <catch2/catch.hpp>
#include <cstdlib>
#include <random>
#include <tactus/clock_map_t.hpp>

#include "tests/sync/support/memory_sink.h"
#include "tests/times.h"

using namespace tactus;
using namespace tactus::sync;
using tactus::test::kSecond;

namespace {

clock_map_t line(std::int32_t of, std::int32_t to, std::int64_t at, std::int64_t offset, double drift, std::int64_t seq = 0,
                 std::int64_t incarnation = 1) {
  clock_map_t m{};
  m.header = header_of("sync_node", incarnation, seq, at);
  m.of_clock = of, m.to_clock = m.header.clock = to;
  m.at_ns = at, m.offset_ns = offset, m.drift = drift, m.uncertainty_ns = 50'000;
  return m;
}
}  // namespace

TEST_CASE("A clock line and its inverse agree within 2 ns for any offset") {
  std::mt19937_64 random(1);
  const auto any = [&](double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); };
  for (int i = 0; i < 10000; ++i) {
    const auto at = static_cast<std::int64_t>(any(0, 1e17)), offset = static_cast<std::int64_t>(any(-1e17, 1e17));
    const ClockLine map(line(1, 2, at, offset, any(-0.002, 0.002)));
    const HostTime to = host_time(at + static_cast<std::int64_t>(any(-1e12, 1e12)));
    const HostTime back = map.of_to_target(map.target_to_of(to).time).time;
    REQUIRE(std::abs((back - to).count()) <= 2);
    REQUIRE(map.target_to_of(to).uncertainty > Nanoseconds(50'000));
  }
}

TEST_CASE("A time is mapped in both directions, and not without a map") {
  ClockMaps maps(7);
  CHECK_FALSE(maps.read(host_time(5), 1, 2));
  CHECK(maps.read(host_time(5), 2, 2)->time == host_time(5));
  maps.observe(line(1, 2, 100 * kSecond, 40 * kSecond, 0), host_time(0));
  CHECK(maps.read(host_time(140 * kSecond), 1, 2)->time == host_time(100 * kSecond));
  CHECK(maps.read(host_time(100 * kSecond), 2, 1)->time == host_time(140 * kSecond));
  CHECK_FALSE(maps.read(host_time(5), 1, 3));
  for (const std::int64_t wild : {std::int64_t{-1}, INT64_MIN, INT64_MAX}) CHECK_FALSE(maps.read(host_time(wild), 1, 2));
}

TEST_CASE("Maps of another run are ignored and counted") {
  ClockMaps maps(7);
  clock_map_t m = line(1, 2, 0, 0, 0);
  m.header.run_id = 8;
  maps.observe(m, host_time(0));
  CHECK(maps.foreign() == 1);
  CHECK_FALSE(maps.read(host_time(5), 1, 2));
}

TEST_CASE("The first of two publishers of a map is used until it falls silent, and late maps are ignored") {
  ClockMaps maps(7);
  const auto offset = [&] { return maps.read(host_time(0), 2, 1)->time; };
  maps.observe(line(1, 2, 0, 100, 0, 5, 1), host_time(0));
  maps.observe(line(1, 2, 0, 200, 0, 9, 2), host_time(kSecond));
  CHECK(offset() == host_time(100));
  maps.observe(line(1, 2, 0, 300, 0, 4, 1), host_time(kSecond));
  CHECK(offset() == host_time(100));
  maps.observe(line(1, 2, 0, 200, 0, 10, 2), host_time(3 * kSecond));
  CHECK(offset() == host_time(200));
}
