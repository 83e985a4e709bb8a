#include "thermal_node/skin/dwell.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <random>

using namespace tactus::thermal;

namespace {
constexpr TemperatureRange kWide{15, 42};
// Seconds at degC until the range narrows; at most an hour.
double allowed_s(double degC) {
  Dwell dwell({60, 20, 60});
  for (int i = 1; i <= 180'000; ++i) {
    const TemperatureRange range = dwell.step(degC, 0.02, kWide);
    if (range.min_degC != kWide.min_degC || range.max_degC != kWide.max_degC) return 0.02 * i;
  }
  return INFINITY;
}
}  // namespace

TEST_CASE("The allowed duration of warmth follows the dose") {
  CHECK(allowed_s(43) == Approx(60).margin(0.05));
  CHECK(allowed_s(42) == Approx(4 * 60).margin(0.05));
  CHECK(allowed_s(41) == Approx(16 * 60).margin(0.1));
  CHECK(allowed_s(44) == Approx(30).margin(0.05));
  CHECK(allowed_s(45) == Approx(15).margin(0.05));
  CHECK(std::isinf(allowed_s(39)));
  CHECK(std::isinf(allowed_s(33)));
}

TEST_CASE("Cold is limited to a minute, cool temperatures are not limited") {
  CHECK(allowed_s(19.9) == Approx(60).margin(0.05));
  CHECK(allowed_s(15) == Approx(60).margin(0.05));
  CHECK(std::isinf(allowed_s(20)));
}

TEST_CASE("After too long an exposure the range is narrow until half of the exposure has decayed") {
  Dwell dwell({60, 20, 60});
  for (int i = 0; i < 61 * 50; ++i) dwell.step(43, 0.02, kWide);
  CHECK(dwell.step(43, 0.02, kWide).max_degC == Dwell::kWarm_degC);
  CHECK(dwell.step(43, 0.02, kWide).min_degC == 15);
  int ticks = 0;
  while (dwell.step(33, 0.02, kWide).max_degC < 42 && ticks < 100'000) ++ticks;
  CHECK(ticks * 0.02 == Approx(Dwell::kDecay_s * std::log(2)).epsilon(0.05));

  Dwell cold({60, 20, 60});
  for (int i = 0; i < 61 * 50; ++i) cold.step(16, 0.02, kWide);
  CHECK(cold.step(16, 0.02, kWide).min_degC == 20);
  for (ticks = 0; cold.step(33, 0.02, kWide).min_degC > 15 && ticks < 100'000;) ++ticks;
  CHECK(ticks * 0.02 == Approx(31).margin(0.2));
}

TEST_CASE("A narrower input range stays narrow") {
  Dwell dwell({60, 20, 60});
  for (int i = 0; i < 61 * 50; ++i) dwell.step(43, 0.02, {25, 36});
  const TemperatureRange range = dwell.step(43, 0.02, {25, 36});
  CHECK(range.min_degC == 25);
  CHECK(range.max_degC == 36);
}

TEST_CASE("The exposure persists across scenes") {
  Dwell before({60, 20, 60});
  for (int i = 0; i < 61 * 50; ++i) before.step(43, 0.02, kWide);
  Dwell after({60, 20, 60});
  after.resume(before);
  CHECK(after.step(43, 0.02, kWide).max_degC == Dwell::kWarm_degC);
}

TEST_CASE("A temperature of NaN counts as the worst, and a zero or negative time step is ignored") {
  Dwell dwell({60, 20, 60});
  for (int i = 0; i < 61 * 50; ++i)
    dwell.step(33, NAN, kWide), dwell.step(43, -1, kWide), dwell.step(43, 0, kWide);
  CHECK(dwell.dose_s() == 0);
  for (int i = 0; i < 241 * 50; ++i) dwell.step(NAN, 0.02, kWide);
  CHECK(dwell.step(NAN, 0.02, kWide).max_degC == Dwell::kWarm_degC);
  CHECK(dwell.step(NAN, 0.02, kWide).min_degC == 20);
}

TEST_CASE("The range is valid and the dose is finite for any input") {
  std::mt19937_64 random(3);
  Dwell dwell({60, 20, 60});
  for (int i = 0; i < 200'000; ++i) {
    const std::uint64_t bits = random();
    double degC;
    std::memcpy(&degC, &bits, sizeof degC);
    if (random() % 2) degC = static_cast<double>(random() % 60);
    const TemperatureRange range = dwell.step(degC, 0.001 * static_cast<double>(random() % 100), kWide);
    REQUIRE(range.min_degC >= 15);
    REQUIRE(range.max_degC <= 42);
    REQUIRE(range.min_degC < range.max_degC);
    REQUIRE(std::isfinite(dwell.dose_s()));
    REQUIRE(std::isfinite(dwell.cold_s()));
  }
}

TEST_CASE("The way to the end of the range and back counts beforehand") {
  // Half a second until the return begins, and 3 K or 5 K at 2 K/s.
  const auto allowed = [](double degC) {
    Dwell dwell({60, 20, 60});
    for (int i = 1; i < 100'000; ++i) {
      const TemperatureRange range = dwell.step(Exposure{degC, degC, degC, 2, 0.5}, 0.02, kWide);
      if (range.min_degC != kWide.min_degC || range.max_degC != kWide.max_degC) return 0.02 * i;
    }
    return 1e9;
  };
  CHECK(allowed(42) == Approx(240 - 0.5 - 1.5).margin(0.05));
  CHECK(allowed(15) == Approx(60 - 0.5 - 2.5).margin(0.05));
  CHECK(allowed(19) == Approx(60 - 0.5 - 2.5).margin(0.05));
}

TEST_CASE("A slow approach to warmth counts like the warmth") {
  Dwell slow({60, 20, 60}), fast({60, 20, 60}), mild({60, 20, 60});
  for (int i = 0; i < 1000; ++i) {
    slow.step(Exposure{39.5, 39.5, 42}, 0.02, kWide);
    fast.step(42, 0.02, kWide);
    mild.step(Exposure{38, 38, 42}, 0.02, kWide);
  }
  CHECK(slow.dose_s() == Approx(fast.dose_s()));
  CHECK(mild.dose_s() == 0);
}

TEST_CASE("One step recovers at most a second, and counts exposure of any length") {
  Dwell dwell({60, 20, 60});
  for (int i = 0; i < 50 * 30; ++i) dwell.step(43, 0.02, kWide);
  dwell.step(33, 1e6, kWide);
  CHECK(dwell.dose_s() == Approx(30 * std::exp(-1 / Dwell::kDecay_s)));
  dwell.step(43, INFINITY, kWide);
  CHECK(dwell.dose_s() == 120);
  dwell.step(16, 1e6, kWide);
  CHECK(dwell.cold_s() == 120);
}

TEST_CASE("An account that is not finite or negative counts as full") {
  for (const double sum : {double{NAN}, double{INFINITY}, -1.0}) {
    Dwell dwell({60, 20, 60});
    dwell.resume(DwellAccount{sum, sum});
    const TemperatureRange range = dwell.step(33, 0.02, kWide);
    CHECK(range.max_degC == Dwell::kWarm_degC);
    CHECK(range.min_degC == 20);
  }
}

TEST_CASE("An account recovers as the limit does") {
  const DwellAccount before{60, 60, true, true};
  Dwell dwell({60, 20, 60});
  dwell.resume(before);
  for (int i = 0; i < 50 * 40; ++i) dwell.step(33, 0.02, kWide);
  const DwellAccount after = before.recovered(40);
  CHECK(after.dose_s == Approx(dwell.dose_s()));
  CHECK(after.cold_s == Approx(dwell.cold_s()).margin(1e-9));
}
