// Tests of tracking simulated time from messages.
#include "sync/clocks/sim_clock_tracker.h"

#include <catch2/catch.hpp>
#include <random>
#include <tactus/header_t.hpp>
#include <tactus/sim_clock_t.hpp>

#include "tests/times.h"

using namespace tactus;
using namespace tactus::sync;
using tactus::test::kMs;

namespace {

header_t header(std::int64_t incarnation, std::int64_t publish_ns, std::int64_t run = 1) {
  header_t h{};
  h.incarnation = incarnation;
  h.publish_time_ns = publish_ns;
  h.run_id = run;
  return h;
}
}  // namespace

TEST_CASE("The first simulation is tracked until it is silent, then a new one replaces it and the old one is ignored") {
  SimClockTracker f(1);
  CHECK_FALSE(f.map(host_time(0)));
  CHECK(f.track(header(1, 0), {0, 0, 1}, host_time(0)) == TrackResult::kRestart);
  CHECK(f.track(header(1, kMs), {kMs, kMs, 1}, host_time(kMs)) == TrackResult::kSame);
  CHECK(f.track(header(2, 2 * kMs), {0, 2 * kMs, 1}, host_time(2 * kMs)) == TrackResult::kIgnore);
  CHECK(f.conflict(host_time(2 * kMs)));
  CHECK(f.track(header(2, 76 * kMs), {0, 76 * kMs, 1}, host_time(76 * kMs)) == TrackResult::kRestart);
  CHECK(f.track(header(1, 77 * kMs), {76 * kMs, 77 * kMs, 1}, host_time(77 * kMs)) == TrackResult::kIgnore);
  CHECK(f.track(header(1, 170 * kMs), {169 * kMs, 170 * kMs, 1}, host_time(170 * kMs)) == TrackResult::kIgnore);
  SECTION("the old one is tracked again after its successor was silent for 0.3 s") {
    CHECK(f.track(header(1, 400 * kMs), {0, 400 * kMs, 1}, host_time(400 * kMs)) == TrackResult::kRestart);
    CHECK(f.incarnation() == 1);
  }
}

TEST_CASE("Simulations with random incarnations do not disturb the tracked one") {
  SimClockTracker f(1);
  std::mt19937_64 random(9);
  for (std::int64_t ms = 0; ms < 2000; ++ms) {
    const TrackResult expected = ms == 0 ? TrackResult::kRestart : TrackResult::kSame;
    CHECK(f.track(header(1, ms * kMs), {ms * kMs, ms * kMs, 1}, host_time(ms * kMs)) == expected);
    for (int i = 0; i < 5; ++i) {
      const auto other = static_cast<std::int64_t>(random() >> 2) + 2;
      const auto stamp = static_cast<std::int64_t>(random() >> 4);
      CHECK(f.track(header(other, stamp), {stamp, stamp, 1}, host_time(ms * kMs)) == TrackResult::kIgnore);
    }
  }
  CHECK(f.map(host_time(2000 * kMs))->to_sim(host_time(2000 * kMs)) == sim_time(2000 * kMs));
  CHECK(f.conflict(host_time(2000 * kMs)));
  CHECK_FALSE(f.conflict(host_time(2300 * kMs)));
}

TEST_CASE("A late message does not move the map back") {
  SimClockTracker f(1);
  f.track(header(1, 10 * kMs), {5 * kMs, 10 * kMs, 1}, host_time(10 * kMs));
  f.track(header(1, 9 * kMs), {4 * kMs, 9 * kMs, 0.5}, host_time(11 * kMs));
  CHECK(f.map(host_time(11 * kMs))->sim == sim_time(5 * kMs));
  CHECK(f.map(host_time(11 * kMs))->rate == 1);
}

TEST_CASE("A forged simulation clock does not move the map") {
  SimClockTracker f(1);
  const auto receive = [&](std::int64_t ms, sim_clock_t clock) {
    return f.track(header(1, ms * kMs), clock, host_time(ms * kMs));
  };
  const auto honest = [](std::int64_t ms, double rate = 1) { return sim_clock_t{ms * kMs, ms * kMs, rate}; };
  for (int ms = 5000; ms < 5100; ++ms) REQUIRE(receive(ms, honest(ms)) != TrackResult::kIgnore);
  SECTION("jump ahead or back") {
    CHECK(receive(5100, {3'600'000 * kMs, 5100 * kMs, 1}) == TrackResult::kIgnore);
    CHECK(receive(5100, {0, 5100 * kMs, 1}) == TrackResult::kIgnore);
    CHECK(f.map(host_time(5100 * kMs))->to_sim(host_time(5100 * kMs)) == sim_time(5100 * kMs));
  }
  SECTION("a forged rate lasts until the next message only") {
    CHECK(receive(5100, {5100 * kMs, 5100 * kMs, 100}) == TrackResult::kSame);
    CHECK(receive(5130, honest(5130)) == TrackResult::kSame);
    CHECK(f.map(host_time(5130 * kMs))->rate == 1);
  }
  SECTION("a simulation that resumes after a stop of 5 s is accepted") {
    CHECK(receive(10100, {5100 * kMs, 10100 * kMs, 1}) == TrackResult::kSame);
    CHECK(f.map(host_time(10100 * kMs))->to_sim(host_time(10100 * kMs)) == sim_time(5100 * kMs));
  }
  SECTION("a paused or slow simulation is accepted") {
    CHECK(receive(5100, {5100 * kMs, 5100 * kMs, 0}) == TrackResult::kSame);
    CHECK(receive(5200, {5100 * kMs, 5200 * kMs, 0}) == TrackResult::kSame);
    CHECK(receive(9000, {5100 * kMs, 9000 * kMs, 0.3}) == TrackResult::kSame);
    CHECK(receive(9100, {5130 * kMs, 9100 * kMs, 0.3}) == TrackResult::kSame);
  }
  SECTION("a forged first message is corrected within 0.3 s") {
    SimClockTracker late(1);
    late.track(header(1, 0), {3'600'000 * kMs, 0, 1}, host_time(0));
    for (int ms = 1; ms <= 301; ++ms) late.track(header(1, ms * kMs), honest(ms), host_time(ms * kMs));
    CHECK(late.map(host_time(301 * kMs))->to_sim(host_time(301 * kMs)) == sim_time(301 * kMs));
  }
}

TEST_CASE("A paused or slow world is mapped by its rate") {
  TimeMap slow{sim_time(0), host_time(0), 0.5};
  CHECK(slow.to_host(sim_time(10)) == host_time(20));
  CHECK(slow.to_sim(host_time(20)) == sim_time(10));
  TimeMap paused{sim_time(3), host_time(7), 0};
  CHECK(paused.to_sim(host_time(1000)) == sim_time(3));
  CHECK(paused.to_host(sim_time(1000)) == host_time(7));
}
