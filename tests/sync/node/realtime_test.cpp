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

TEST_CASE("A loop that overran its share leaves FIFO, and returns after ten seconds without overload") {
  using Change = PriorityKeeper::Change;
  PriorityKeeper keeper;
  HostTime now = host_time(1'000'000'000);
  int left = 0, returned = 0;
  HostTime returned_at{};
  const auto run = [&](int ms, std::int64_t busy_us) {
    for (const HostTime end = now + Nanoseconds(ms * 1'000'000LL); now < end; now += Nanoseconds(1'000'000)) {
      const Change change = keeper.tick(now, now + Nanoseconds(busy_us * 1000));
      left += change == Change::kLeave;
      if (change == Change::kReturn) ++returned, returned_at = now;
    }
  };
  for (int round = 1; round <= 3; ++round) {
    run(1000, 950);
    CHECK(left == round);  // once, not in every window
    CHECK(keeper.demoted());
    run(5000, 300);
    CHECK(returned == round - 1);
    run(500, 950);  // overload again: the time counts from its end
    const HostTime calm = now;
    run(12'000, 300);
    CHECK(returned == round);
    CHECK_FALSE(keeper.demoted());
    // Windows of 100 ms: one of them may hold the end of the overload.
    CHECK(returned_at - calm > Nanoseconds(9'800'000'000));
    CHECK(returned_at - calm < Nanoseconds(10'300'000'000));
  }
}

TEST_CASE("A loop that was stopped for a minute leaves FIFO at most once, and returns") {
  PriorityKeeper keeper;
  HostTime now = host_time(1'000'000'000);
  int left = 0, returned = 0;
  for (int i = 0; i < 20'000; ++i, now += Nanoseconds(1'000'000)) {
    const Nanoseconds busy = i == 1000 ? Nanoseconds(60'000'000'000) : Nanoseconds(200'000);
    const auto change = keeper.tick(now, now + busy);
    if (i == 1000) now += busy;
    left += change == PriorityKeeper::Change::kLeave;
    returned += change == PriorityKeeper::Change::kReturn;
  }
  CHECK(left == 1);
  CHECK(returned == 1);
}

TEST_CASE("Memory is locked without a limit, or with the capability outside user namespaces") {
  const std::string initial = "         0          0 4294967295\n", container = "         0     100000      65536\n";
  constexpr std::uint64_t kNone = 0, kLock = 1 << 14, kAll = (std::uint64_t{1} << 41) - 1;
  CHECK(can_lock_all_memory(false, kNone, container));
  CHECK(can_lock_all_memory(true, kLock, initial));
  CHECK(can_lock_all_memory(true, kAll, initial));
  CHECK_FALSE(can_lock_all_memory(true, kNone, initial));
  CHECK_FALSE(can_lock_all_memory(true, kAll & ~kLock, initial));
  CHECK_FALSE(can_lock_all_memory(true, kAll, container));
  CHECK_FALSE(can_lock_all_memory(true, kAll, ""));
}

TEST_CASE("Normal scheduling is reported when real-time priority is off or zero") {
  CHECK(set_realtime(Realtime::kOff, 60) == "normal scheduling");
  CHECK(set_realtime(Realtime::kRequire, 0) == "normal scheduling");
  CHECK_FALSE(is_realtime());
}
