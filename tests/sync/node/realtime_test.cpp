// Tests of the overrun guard of real-time loops.
#include "sync/node/realtime.h"

#include <catch2/catch.hpp>
#include <random>

using namespace tactus::sync;

namespace {

// Runs ticks of 1 ms for 1 s, each busy for busy_share of its period. Returns the number of demotions by the guard.
int demotions(double busy_share, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> wobble(0.9, 1.1);
  OverrunGuard guard;
  int called = 0;
  for (int i = 0; i < 1000; ++i) {
    const HostTime begin = host_time(1'000'000'000LL + i * 1'000'000LL);
    called += guard.tick(begin, begin + Nanoseconds(static_cast<std::int64_t>(busy_share * wobble(random) * 1e6)));
  }
  return called;
}

}  // namespace

TEST_CASE("A loop that uses 70 % of its time is not demoted") {
  for (unsigned seed = 0; seed < 20; ++seed) CHECK(demotions(0.7, seed) == 0);
}

TEST_CASE("A loop that uses more than 80 % of its time for 100 ms is demoted") {
  for (unsigned seed = 0; seed < 20; ++seed) CHECK(demotions(0.9, seed) >= 9);
}

TEST_CASE("One long tick between idle ones is accepted, a tick of more than 100 ms is not") {
  OverrunGuard guard;
  const auto at = [](int ms) { return host_time(1'000'000'000LL + ms * 1'000'000LL); };
  CHECK_FALSE(guard.tick(at(0), at(1)));
  CHECK_FALSE(guard.tick(at(20), at(70)));
  CHECK_FALSE(guard.tick(at(109), at(110)));
  CHECK(guard.tick(at(111), at(300)));
}

TEST_CASE("calm() is the time since the loop last exceeded its share") {
  OverrunGuard guard;
  HostTime now = host_time(1'000'000'000);
  const auto run = [&](int ms, std::int64_t busy_us) {
    for (const HostTime end = now + Nanoseconds(ms * 1'000'000LL); now < end; now += Nanoseconds(1'000'000))
      guard.tick(now, now + Nanoseconds(busy_us * 1000));
  };
  run(5000, 300);
  CHECK(guard.time_below_limit() > Nanoseconds(4'500'000'000));
  run(250, 950);
  CHECK(guard.time_below_limit() == Nanoseconds(0));
  run(10'200, 300);
  CHECK(guard.time_below_limit() >= Nanoseconds(10'000'000'000 - 200'000'000));
}

TEST_CASE("Normal scheduling is reported when real-time priority is off or zero") {
  CHECK(set_realtime(Realtime::kOff, 60) == "normal scheduling");
  CHECK(set_realtime(Realtime::kRequire, 0) == "normal scheduling");
  CHECK_FALSE(is_realtime());
}
