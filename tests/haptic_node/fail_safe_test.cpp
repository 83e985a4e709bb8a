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

TEST_CASE("The fade also limits a transient whose wall gives way") {
  // Touch returns through a slow fade. The hand leaves the wall quickly, so its energy is used up, while a transient
  // pulls into the wall.
  std::mt19937 random(365);
  const auto draw = [&](double from, double to) { return from + (to - from) * 1e-6 * (random() % 1'000'001); };
  int pulled = 0;
  for (int round = 0; round < 200; ++round) {
    Settings s;
    s.force_limit_N = draw(0.1, 2);
    s.fade_s = 0.2;
    s.transient_limit_N = 3;
    s.transient_gain = 5;
    Bench bench(s);
    const auto m = model(0, {plane(7, Vector3d::Zero(), Vector3d::UnitZ())});
    const double enters_ms = draw(5, 100), depth_m = draw(1e-4, 2e-3), leaves_m = draw(0.5e-4, 5e-4);
    double z = 0.0052;
    for (int ms = 0; ms < 150; ++ms) {
      z = ms < enters_ms ? 0.0052 : ms < enters_ms + 4 ? 0.005 - depth_m : std::min(0.0052, z + leaves_m);
      std::vector<contact_event_t> events;
      if (ms % 7 == 0) {
        auto e = event(ms + 1, contact_event_t::HIT, ms);
        e.normal = to_vec3f(random() % 2 ? Vector3d::UnitZ() : Vector3d(-Vector3d::UnitZ()));
        e.approach_speed_m_s = static_cast<float>(draw(0.01, 1));
        events.push_back(e);
      }
      const auto& out = bench.tick(ms, {0, 0, z}, &m, events);
      CAPTURE(round, ms, s.force_limit_N, out.state.fade, out.force_N.z());
      // The state holds the fade in single precision.
      CHECK(out.force_N.norm() <= s.force_limit_N * out.state.fade + 1e-6);
      pulled += out.force_N.z() < -0.01 && z < 0.005;
    }
  }
  CHECK(pulled > 100);
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
