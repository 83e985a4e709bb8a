// Tests of the last check before a plate.
#include "thermal_node/devices/display_guard.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <random>

#include "tests/thermal_node/support/device_time.h"
#include "tests/thermal_node/support/limits_trial.h"
#include "thermal_node/devices/simulated_peltier.h"

using namespace tactus;
using namespace tactus::thermal;
using tactus::thermal::test::at;
using tactus::thermal::test::kClock;

namespace {

constexpr std::int64_t kRun = 4;

thermal_state_t command(float degC, std::int64_t seq, std::int64_t sent_ms, std::int64_t incarnation = 5) {
  thermal_state_t m{};
  m.header = {-1, sync::to_ns(at(sent_ms)), kClock, kRun, 9, incarnation, seq};
  m.commanded_degC = degC;
  m.heat_flux_W_m2 = 1000;
  return m;
}

// A guard with a plate that follows at once, stepped every 10 ms, and thermal_node beside it.
struct Guarded {
  explicit Guarded(const Settings& settings = {}) : guard(settings, 0, kRun, kClock) {}
  GuardedTarget follow(float degC, int ticks, std::int64_t incarnation = 5) {
    for (int i = 0; i < ticks; ++i) {
      ms += 10;
      if (std::isfinite(degC)) guard.receive(command(degC, ++seq, ms, incarnation), at(ms));
      target = guard.step(target.target_degC, at(ms));
    }
    return target;
  }
  // Without commands.
  GuardedTarget wait(int ticks) { return follow(NAN, ticks); }
  bool complains(const char* part) const { return target.problem && std::strstr(target.problem, part); }

  DisplayGuard guard;
  GuardedTarget target;
  std::int64_t ms = 0, seq = 0;
};

}  // namespace

TEST_CASE("The guard passes a command within the limits, at the slew limit") {
  Guarded g;
  CHECK(g.follow(25, 25).target_degC == 33);  // not trusted yet
  g.follow(25, 150);
  CHECK(g.target.target_degC == 25);
  CHECK(g.target.problem == nullptr);
  CHECK(g.target.load_W == Approx(0.1));
  CHECK_FALSE(g.target.limited);
  CHECK(g.follow(30, 1).target_degC == Approx(25.2));
}

TEST_CASE("A command beyond the range of the display is cut to it") {
  Guarded g;
  CHECK(g.follow(1000, 200).target_degC == 42);
  CHECK(g.target.limited);
  CHECK(g.follow(-1000, 400).target_degC == 15);
}

TEST_CASE(
    "A guarded plate returns to neutral without commands, with old ones, with two senders and with a date ahead") {
  Guarded g;
  g.follow(40, 200);
  REQUIRE(g.target.target_degC == 40);
  SECTION("none") {
    g.wait(31);
    CHECK(g.complains("no THERMAL_STATE"));
  }
  SECTION("repeated") {
    for (int i = 0; i < 30; ++i) {
      g.guard.receive(command(40, g.seq, g.ms), at(g.ms + 10));
      g.wait(1);
    }
    g.wait(1);
    CHECK(g.complains("no THERMAL_STATE"));
  }
  SECTION("old") {
    for (int i = 0; i < 31; ++i) {
      g.guard.receive(command(40, ++g.seq, g.ms - 500), at(g.ms + 10));
      g.wait(1);
    }
    CHECK(g.complains("no THERMAL_STATE"));
  }
  SECTION("ahead") {
    g.guard.receive(command(40, ++g.seq, g.ms + 60'000), at(g.ms));
    g.follow(40, 1);
    CHECK(g.complains("dated ahead"));
  }
  SECTION("two senders") {
    g.guard.receive(command(20, 0, g.ms, 6), at(g.ms));
    g.follow(40, 1);
    CHECK(g.complains("two programs"));
  }
  // 7 K at 20 K/s.
  g.wait(36);
  CHECK(g.target.target_degC == 33);
}

TEST_CASE("A successor of the sender is obeyed within a second") {
  Guarded g;
  g.follow(40, 200);
  g.follow(30, 100, 6);
  CHECK(g.target.problem == nullptr);
  CHECK(g.follow(30, 20, 6).target_degC == 30);
}

TEST_CASE("The guard ignores commands of other tools and other runs") {
  Guarded g;
  thermal_state_t m = command(40, 0, 0);
  m.tool = 1;
  g.guard.receive(m, at(0));
  m = command(40, 0, 0);
  m.header.run_id = kRun + 1;
  g.guard.receive(m, at(0));
  CHECK_FALSE(g.guard.has_command());
  CHECK(g.wait(1).target_degC == 33);
}

TEST_CASE("The guard keeps the exposure within the limits for any commands") {
  const Settings settings;
  for (const float degC : {42.f, 15.f}) {
    Guarded g;
    test::TrueExposure exposure;
    for (int i = 0; i < 100 * 400; ++i) {
      g.follow(degC, 1);
      exposure.add(g.target.target_degC, 0.01, settings);
      REQUIRE(exposure.dose_s <= settings.dose_max_s);
      REQUIRE(exposure.cold_s <= settings.cold_max_s);
    }
    CHECK(std::max(g.guard.dwell().dose_s(), g.guard.dwell().cold_s()) > 30);
    // A restarted guard continues with the exposure.
    Guarded restarted;
    restarted.guard.resume(g.guard.account_after(0.4));
    CHECK(restarted.guard.dwell().dose_s() >= g.guard.dwell().dose_s() * 0.99);
    CHECK(restarted.guard.dwell().cold_s() >= g.guard.dwell().cold_s() - 0.4);
  }
}

TEST_CASE("A plate that runs away or a sensor that fails switches the display off") {
  DisplayGuard guard({}, 0, kRun, kClock);
  guard.step(33, at(0));
  CHECK_FALSE(guard.step(44, at(10)).off);
  CHECK(guard.step(46, at(20)).off);
  CHECK(guard.step(NAN, at(30)).off);
  CHECK_FALSE(guard.step(40, at(40)).off);
  // A plate that was cold from the start is heated; one that becomes colder is switched off.
  DisplayGuard cold({}, 0, kRun, kClock);
  CHECK_FALSE(cold.step(5, at(0)).off);
  CHECK_FALSE(cold.step(5, at(10)).off);
  CHECK_FALSE(cold.step(6, at(20)).off);
  CHECK(cold.step(5, at(30)).off);
}

TEST_CASE("No messages bring a guarded plate beyond a limit") {
  std::mt19937_64 random(11);
  const auto any_float = [&] {
    const auto bits = static_cast<std::uint32_t>(random());
    float x;
    std::memcpy(&x, &bits, sizeof x);
    return random() % 2 ? x : static_cast<float>(random() % 80) - 20;
  };
  const Settings settings;
  DisplayGuard guard(settings, 0, kRun, kClock);
  SimulatedPeltier plate({}, {}, 33);
  test::TrueExposure exposure;
  double degC = 33, before = 33;
  std::int64_t ms = 0;
  for (int i = 0; i < 200'000; ++i) {
    ms += 10;
    for (std::size_t n = random() % 4; n > 0; --n) {
      const std::int64_t seq = random() % 5 ? i : static_cast<std::int64_t>(random() >> 1);
      const std::int64_t sent_ms = random() % 9 ? ms : ms + static_cast<std::int64_t>(random() % 2000) - 1000;
      const std::int64_t sender = random() % 500 ? 5 : static_cast<std::int64_t>(random() % 5);
      thermal_state_t m = command(any_float(), seq, sent_ms, sender);
      m.heat_flux_W_m2 = any_float();
      guard.receive(m, at(ms));
    }
    const GuardedTarget t = guard.step(degC, at(ms));
    degC = plate.step(t.target_degC, t.load_W, at(ms))->plate_degC;
    exposure.add(degC, 0.01, settings);
    REQUIRE(t.target_degC >= settings.temperature_min_degC);
    REQUIRE(t.target_degC <= settings.temperature_max_degC);
    REQUIRE(std::isfinite(t.load_W));
    // The slew limit, or the way from 15 degC into the range above 20 degC.
    REQUIRE(std::abs(t.target_degC - before) <= 5 + 0.2 + 1e-9);
    REQUIRE(exposure.dose_s <= settings.dose_max_s);
    REQUIRE(exposure.cold_s <= settings.cold_max_s);
    before = t.target_degC;
  }
}
