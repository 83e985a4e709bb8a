// After each kind of failure the force fades to zero, and it returns only through a fade.
#include <catch2/catch.hpp>
#include <limits>
#include <random>
#include <tactus/touch_model_t.hpp>
#include <tactus/touch_plane_t.hpp>

#include "tests/haptic_node/support/trial.h"
#include "tests/haptic_node/support/world.h"

using namespace tactus;
using namespace tactus::haptic;
using namespace tactus::haptic::test;

namespace {

struct Named {
  const char* name;
  Failure failure;
};
constexpr Named kAll[] = {{"no touch models", Failure::kModels}, {"device lost", Failure::kDevice},
                          {"state not finite", Failure::kNotFinite}, {"stall", Failure::kStall},
                          {"restart of the simulation", Failure::kRestart}, {"step of the clock", Failure::kClock}};

}  // namespace

TEST_CASE("After any failure at any moment the force fades to zero and returns through a fade") {
  std::mt19937 random(16);
  for (const Named& kind : kAll)
    for (int round = 0; round < 50; ++round) {
      TrialDef def = metronome();
      def.taps = 8;
      def.hold_s = 0.15;  // mostly pressed
      def.failure = kind.failure;
      def.failure_s = 0.3 + 1e-3 * static_cast<double>(random() % 500);
      def.stall_s = kind.failure == Failure::kStall ? 0.021 + 1e-4 * static_cast<double>(random() % 6000) : 0;
      def.mass_kg = round % 2 ? 0.5 : 0;
      def.hits = round % 4 > 1;
      const TrialResult r = run_trial(def);
      CAPTURE(kind.name, round, def.failure_s, def.stall_s, def.mass_kg);
      CHECK(r.finite);
      CHECK(r.beyond_fade_N < 1e-9);
      CHECK(r.beyond_rise_N < 1e-9);
      CHECK(r.beyond_force_N < 1e-9);
      CHECK(r.peak_N > 1);
    }
}

TEST_CASE("A loop that stalled begins from zero, with the slew limit in its first tick") {
  Bench bench;
  const auto m = model(0, {plane(7, Vector3d::Zero(), Vector3d::UnitZ())});
  for (int ms = 0; ms < 100; ++ms) bench.tick(ms, {0, 0, 0.004}, &m);
  const double before = bench.tick(100, {0, 0, 0.004}, &m).force_N.z();
  REQUIRE(before == Approx(1).epsilon(0.01));
  // Without the force of the wall the hand has moved 7 mm deeper, and new models are waiting.
  double last = 0;
  for (int ms = 600; ms < 700; ++ms) {
    const double force = bench.tick(ms, {0, 0, -0.003}, &m).force_N.z();
    CHECK(force <= 8.0 * (ms - 599) / 20 + 1e-9);
    CHECK(force - last <= 2 + 1e-9);
    last = force;
  }
  CHECK(last > 6);
}

TEST_CASE("Arrivals ahead of the clock do not keep the force after the clock stepped back") {
  Bench bench;
  const auto m = model(0, {plane(7, Vector3d::Zero(), Vector3d::UnitZ())});
  for (int ms = 1000; ms < 1100; ++ms) bench.tick(ms, {0, 0, 0.004}, &m);
  // The clock falls back by half a second, and no model arrives any more.
  double force = 0;
  for (int ms = 600; ms < 900; ++ms) {
    force = bench.tick(ms, {0, 0, 0.004}).force_N.norm();
    CHECK(force == 0);
  }
}

TEST_CASE("A device whose state is not finite is lost") {
  Bench bench;
  const auto m = model(0, {plane(7, Vector3d::Zero(), Vector3d::UnitZ())});
  for (int ms = 0; ms < 100; ++ms) bench.tick(ms, {0, 0, 0.003}, &m);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (int ms = 100; ms < 200; ++ms) {
    const auto& out = bench.tick(ms, {nan, 0, 0}, &m);
    CHECK(bench.renderer.device_lost());
    if (ms >= 120) CHECK(out.force_N.norm() == 0);
  }
}

TEST_CASE("A restarted simulation is touched only after the force of the old one has faded") {
  Bench bench;
  const auto old = model(0, {plane(7, Vector3d::Zero(), Vector3d::UnitZ())});
  const auto other = model(0, {plane(8, {0, 0, 0.002}, Vector3d::UnitZ())});
  for (int ms = 0; ms < 100; ++ms) bench.tick(ms, {0, 0, 0.003}, &old);
  double last = bench.tick(100, {0, 0, 0.003}, &old).force_N.z();
  for (int ms = 101; ms < 200; ++ms) {
    TickInput in;
    in.restarted = ms == 101;
    const auto& out = bench.tick(ms, {0, 0, 0.003}, &other, {}, in);
    const double force = out.force_N.z();
    CAPTURE(ms);
    if (ms <= 120) CHECK(force == Approx(last - 0.1).margin(1e-6));
    if (ms == 120) CHECK(force == Approx(0).margin(1e-6));
    CHECK(std::abs(force - last) < 0.5);
    for (const auto& c : out.state.constraints)
      if (c.force_N.z > 0) CHECK(c.contact_id == (ms < 121 ? 7 : 8));
    last = force;
  }
  CHECK(last == Approx(4).epsilon(0.01));
}
