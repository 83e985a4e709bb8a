// Tests of periodic deadlines: no burst, missed ticks are counted.
#include "sync/clocks/pacing.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <stdexcept>

using namespace tactus::sync;

namespace {
constexpr HostTime kStart = host_time(1'000'000'000);
}

TEST_CASE("Deadlines are exact to 1 ns after an hour") {
  for (const double rate : {50.0, 60.0, 59.94, 1000.0, 4000.0, 7.0}) {
    Deadlines d(rate, kStart);
    const std::int64_t ticks = std::llround(3600 * rate);
    for (std::int64_t i = 0; i < ticks; ++i) d.advance(d.next());
    INFO(rate);
    CHECK(std::abs((d.next() - kStart).count() - static_cast<double>(ticks) / rate * 1e9) <= 1);
    CHECK(d.missed() == 0);
    CHECK(d.ticks() == ticks);
  }
}

TEST_CASE("A loop that wakes late by less than a period keeps its deadlines") {
  std::mt19937 random(1);
  std::uniform_int_distribution<std::int64_t> late(0, 999'000);
  Deadlines d(1000, kStart);
  for (int i = 1; i <= 10000; ++i) {
    CHECK(d.advance(d.next() + Nanoseconds(late(random))) == 0);
    REQUIRE(d.next() == kStart + Nanoseconds(i * 1'000'000LL));
  }
}

TEST_CASE("A late loop skips whole periods, counts them and never catches up in a burst") {
  std::mt19937_64 random(2);
  for (const double rate : {60.0, 1000.0, 333.0}) {
    Deadlines d(rate, kStart);
    const double period_ns = 1e9 / rate;
    HostTime now = kStart;
    std::int64_t periods = 0;
    for (int i = 0; i < 5000; ++i) {
      // Mostly on time, sometimes up to 20 periods late.
      const double lateness = random() % 10 ? 0.5 * period_ns : 20 * period_ns;
      now = d.next() +
            Nanoseconds(static_cast<std::int64_t>(lateness * static_cast<double>(random() % 1000) / 1000));
      const HostTime before = d.next();
      periods += 1 + d.advance(now);
      // The next deadline is in the future by at most one period, with 1 ns for rounding: no burst.
      REQUIRE(d.next() - now >= Nanoseconds(-1));
      REQUIRE(static_cast<double>((d.next() - now).count()) <= period_ns + 1);
      REQUIRE(d.next() > before);
    }
    // Every period was either ticked or counted as missed.
    CHECK(d.ticks() + d.missed() == periods);
    CHECK(std::abs(static_cast<double>((d.next() - kStart).count()) - static_cast<double>(periods) * period_ns) <=
          1);
  }
}

TEST_CASE("A tick that a signal wakes early is not a miss") {
  Deadlines d(100, kStart);
  CHECK(d.advance(kStart - Nanoseconds(5)) == 0);
  CHECK(d.next() == kStart + Nanoseconds(10'000'000));
}

TEST_CASE("The rate may change at any deadline") {
  Deadlines d(1000, kStart);
  for (int i = 0; i < 7; ++i) d.advance(d.next());
  d.set_rate(50);
  const HostTime changed = d.next();
  d.advance(d.next());
  CHECK(d.next() == changed + Nanoseconds(20'000'000));
  d.set_rate(50);
  d.advance(d.next());
  CHECK(d.next() == changed + Nanoseconds(40'000'000));
}

TEST_CASE("An invalid rate is rejected") {
  for (const double rate : {0.0, -1.0, 10001.0, std::nan(""), HUGE_VAL})
    CHECK_THROWS_AS(Deadlines(rate, kStart), std::invalid_argument);
  CHECK_NOTHROW(Deadlines(10000, kStart));
}

TEST_CASE("The host clock is monotone") {
  HostTime before = host_now();
  for (int i = 0; i < 1000; ++i) {
    const HostTime now = host_now();
    REQUIRE(now >= before);
    before = now;
  }
}

TEST_CASE("Aligning a loop moves its deadlines and counts the skipped ticks as missed") {
  Deadlines d(60, kStart);
  d.advance(d.next());
  const HostTime elsewhere = kStart + Nanoseconds(90'000'000);
  d.align(elsewhere, 4);
  CHECK(d.next() == elsewhere);
  CHECK(d.missed() == 4);
  CHECK(d.advance(elsewhere + Nanoseconds(1'000'000)) == 0);
  CHECK(d.ticks() == 2);
  CHECK(d.next() == elsewhere + Nanoseconds(16'666'667));
  for (int i = 0; i < 59; ++i) d.advance(d.next());
  CHECK(d.next() == elsewhere + Nanoseconds(1'000'000'000));
}
