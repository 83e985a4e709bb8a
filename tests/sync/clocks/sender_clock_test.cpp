// Tests of the choice of the clock source for a sender.
#include "sync/clocks/sender_clock.h"

#include <catch2/catch.hpp>
#include <tactus/clock_map_t.hpp>
#include <tactus/header_t.hpp>

#include "tests/sync/support/memory_sink.h"
#include "tests/times.h"

using namespace tactus;
using namespace tactus::sync;
using tactus::test::kMs;
using tactus::test::kSecond;

namespace {

constexpr std::int64_t kRun = 7, kAhead = 5'000 * kSecond;
constexpr std::int32_t kOurs = 1, kTheirs = 2;

header_t stamped(std::int64_t publish_ns, std::int32_t clock, std::int64_t run = kRun) {
  header_t h = header_of("sim_node", 1, 0, publish_ns, run);
  h.clock = clock;
  return h;
}

clock_map_t map_of(std::int64_t offset_ns, std::int64_t at_ns, std::int64_t seq, std::int32_t epoch = 0) {
  clock_map_t m{};
  m.header = header_of("sync_node", 1, seq, at_ns, kRun);
  m.of_clock = kTheirs, m.to_clock = m.header.clock = kOurs;
  m.at_ns = at_ns, m.offset_ns = offset_ns, m.uncertainty_ns = 100'000, m.uncertainty_drift = 20e-6, m.epoch = epoch;
  return m;
}

struct Fixture {
  ClockMaps maps{kRun};
  SenderClock clock{OwnClock(kRun, kOurs, &maps)};
};

}  // namespace

TEST_CASE("The clock of an unknown sender maps to itself") {
  Fixture f;
  CHECK(f.clock.to_host(77, host_time(5)) == host_time(77));
  CHECK(f.clock.read(77, host_time(5)).source == SenderClock::ClockSource::kUnknown);
}

TEST_CASE("Stamps of the own run and clock are used unchanged") {
  Fixture f;
  CHECK_FALSE(f.clock.observe(stamped(1000, kOurs), host_time(999'999)));
  CHECK(f.clock.to_host(1234, host_time(5'000'000)) == host_time(1234));
  CHECK(f.clock.read(1234, host_time(5'000'000)).uncertainty == Nanoseconds(0));
}

TEST_CASE("Stamps of another clock are mapped with their uncertainty, or by arrival if there is no map") {
  Fixture f;
  const HostTime now = host_time(100 * kSecond);
  f.clock.observe(stamped(to_ns(now) + kAhead - 3 * kMs, kTheirs), now);
  CHECK(f.clock.read(to_ns(now) + kAhead, now).source == SenderClock::ClockSource::kOneWay);
  CHECK(f.clock.read(to_ns(now) + kAhead, now).time - now == Nanoseconds(3 * kMs));
  CHECK(f.clock.read(to_ns(now) + kAhead, now).uncertainty == Nanoseconds(-1));
  f.maps.observe(map_of(kAhead, to_ns(now), 0), now);
  const auto mapped = f.clock.read(to_ns(now) + kAhead, now);
  CHECK(mapped.source == SenderClock::ClockSource::kMapped);
  CHECK(mapped.time == now);
  CHECK(mapped.uncertainty >= Nanoseconds(100'000));
  CHECK(mapped.uncertainty < Nanoseconds(101'000));

  SECTION("without updates the uncertainty of a map grows until arrivals replace it") {
    const HostTime later = now + Nanoseconds(10 * kSecond);
    CHECK(f.clock.read(to_ns(later) + kAhead, later).uncertainty >= Nanoseconds(300'000));
    const HostTime much_later = now + Nanoseconds(2'000 * kSecond);
    f.clock.observe(stamped(to_ns(much_later) + kAhead - kMs, kTheirs), much_later);
    CHECK(f.clock.read(to_ns(much_later) + kAhead, much_later).source == SenderClock::ClockSource::kOneWay);
  }
}

TEST_CASE("A replayed log is read by arrival, also if its clock is mapped or the own one") {
  Fixture f;
  const HostTime now = host_time(100 * kSecond);
  f.maps.observe(map_of(kAhead, to_ns(now), 0), now);
  for (const std::int32_t clock : {kOurs, kTheirs}) {
    SenderClock replayed{OwnClock(kRun, kOurs, &f.maps)};
    replayed.observe(stamped(5 * kSecond, clock, kRun + 1), now);
    CHECK(replayed.read(5 * kSecond, now).source == SenderClock::ClockSource::kOneWay);
    CHECK(replayed.to_host(5 * kSecond, now) == now);
  }
}

TEST_CASE("A map that contradicts the stamps is ignored until the probes have measured the jump") {
  Fixture f;
  const HostTime now = host_time(100 * kSecond);
  f.maps.observe(map_of(kAhead, to_ns(now), 0), now);
  const auto sent = [&](HostTime t, std::int64_t jump) { return stamped(to_ns(t) + kAhead + jump - kMs, kTheirs); };
  REQUIRE_FALSE(f.clock.observe(sent(now, 0), now));
  SECTION("jump forward: stamps lie in the future of the map") {
    const std::int64_t jump = 50 * kMs;
    const HostTime t = now + Nanoseconds(kSecond);
    CHECK(f.clock.observe(sent(t, jump), t));
    CHECK(f.clock.read(to_ns(t) + kAhead + jump, t).source == SenderClock::ClockSource::kOneWay);
    CHECK(f.clock.to_host(to_ns(t) + kAhead + jump, t) - t <= Nanoseconds(kMs));
    const HostTime later = t + SenderClock::kDistrust;
    f.maps.observe(map_of(kAhead + jump, to_ns(later), 5, 1), later);
    CHECK(f.clock.read(to_ns(later) + kAhead + jump, later).source == SenderClock::ClockSource::kMapped);
    CHECK(f.clock.to_host(to_ns(later) + kAhead + jump, later) == later);
  }
  SECTION("late messages after a stall do not invalidate the map") {
    const HostTime t = now + Nanoseconds(5 * kSecond);
    CHECK_FALSE(f.clock.observe(sent(now, 0), t));
    CHECK(f.clock.read(to_ns(t) + kAhead, t).source == SenderClock::ClockSource::kMapped);
    CHECK(f.clock.to_host(to_ns(t) + kAhead, t) == t);
  }
  SECTION("jump back: stamps appear delayed until the map of the new epoch arrives") {
    const std::int64_t jump = -500 * kMs;
    const HostTime t = now + Nanoseconds(3 * kSecond);
    CHECK_FALSE(f.clock.observe(sent(t, jump), t));
    f.maps.observe(map_of(kAhead + jump, to_ns(t), 5, 1), t);
    CHECK(f.clock.to_host(to_ns(t) + kAhead + jump, t) == t);
  }
}
