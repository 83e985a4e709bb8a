#include "haptic_node/safety/wall_energy.h"

#include <catch2/catch.hpp>
#include <limits>

#include "tests/haptic_node/support/tick.h"
#include "tests/haptic_node/support/trial.h"
#include "tests/haptic_node/support/world.h"

using namespace tactus;
using namespace tactus::haptic;
using namespace tactus::haptic::test;

namespace {

// A spring of 1 N/mm whose end the test moves; force and motion along z.
struct Spring {
  // Moves the hand to this depth. Returns the force that acts from now on.
  double to(double depth_m, double force_share = 1, bool appears = false) {
    walls.observe(500 * depth_m * depth_m, depth_m > 0, {Vector3d(0, 0, depth - depth_m), Vector3d::Zero()}, kDt,
                  appears ? 500 * depth_m * depth_m : 0);
    given_J += force * (depth - depth_m);
    depth = depth_m;
    force = force_share * walls.factor() * 1000 * depth_m;
    walls.record({{Vector3d(0, 0, force), Vector3d::Zero()}, {}, 0});
    return force;
  }
  WallEnergy walls{WallLimits{}};
  double depth = 0, force = 0, given_J = 0;
};

}  // namespace

TEST_CASE("A wall that the hand pressed keeps its stiffness") {
  Spring spring;
  for (int k = 0; k <= 100; ++k) CHECK(spring.to(5e-5 * k) == Approx(0.05 * k));
  for (int k = 100; k >= 0; --k) CHECK(spring.to(5e-5 * k) == Approx(0.05 * k));
  CHECK(spring.walls.generated_J() == Approx(spring.given_J).margin(1e-12));
}

TEST_CASE("The springs of a wall that appears above the hand hold at most the allowance") {
  Spring spring;
  spring.to(0.005);
  CHECK(spring.force < 0.5);
  for (int k = 99; k >= 0; --k) spring.to(5e-5 * k);
  CHECK(spring.given_J > 0.0001);
  CHECK(spring.given_J < 0.0006);
  CHECK(spring.walls.generated_J() == Approx(spring.given_J).margin(1e-9));
}

TEST_CASE("A wall whose force came late returns no more energy than it received") {
  Spring spring;
  // A tenth of the force while the hand presses, all of it while the hand withdraws.
  for (int k = 0; k <= 100; ++k) spring.to(5e-5 * k, 0.1);
  for (int k = 100; k >= 0; --k) spring.to(5e-5 * k);
  CHECK(spring.given_J < 0.0006);
}

TEST_CASE("While touch begins the energy of the springs is credited") {
  Spring spring;
  for (int k = 0; k < 20; ++k) spring.to(2.5e-4 * k, 1, true);
  CHECK(spring.to(0.005) == Approx(5));
}

TEST_CASE("A softened wall recovers after the hand was away") {
  Spring spring;
  CHECK(spring.to(0.002) < 1);
  for (int k = 0; k < 250; ++k) spring.to(0);
  for (int k = 0; k <= 40; ++k) spring.to(5e-5 * k);
  CHECK(spring.force == Approx(2));
}

TEST_CASE("The brake lets the next tick give at most the credit") {
  WallEnergy walls{WallLimits{}};
  const WallForce push{{Vector3d(0, 0, 5), Vector3d::Zero()}, {}, 0};
  CHECK(walls.brake(push, {Vector3d(0, 0, 0.001), Vector3d::Zero()}, kDt) == 0);
  // The hand presses 0.1 mm deep at 5 N: 0.5 mJ. Then 1 mm at 5 N are 5 mJ, of which nine tenths of the credit cover a part; the force
  // itself adds 25 N^2 / 0.1 kg (1 ms)^2.
  walls.record(push);
  walls.observe(0, true, {Vector3d(0, 0, -0.0001), Vector3d::Zero()}, kDt, 0);
  const double kept = walls.brake(push, {Vector3d(0, 0, 0.001), Vector3d::Zero()}, kDt);
  CHECK(kept == Approx(0.9 * 0.0005 / (0.005 + 25 / 0.1 * 1e-6)));
  CHECK(walls.brake(push, {Vector3d(0, 0, -0.001), Vector3d::Zero()}, kDt) == 1);
  // A surface that moves with the hand does the work itself.
  const WallForce belt{push.wrench, {}, 5};
  CHECK(walls.brake(belt, {Vector3d(0, 0, 0.001), Vector3d::Zero()}, kDt) == 1);
}

TEST_CASE("Only the forces of fixed surfaces count, with their torque and their own motion") {
  std::vector<Surface> surfaces(3);
  surfaces[0].effective_mass_kg = 1;
  surfaces[1].effective_mass_kg = surfaces[2].effective_mass_kg = 1e10;
  surfaces[2].velocity = {0.5, 0, 0};
  const std::vector<Vector3d> forces{{1, 2, 3}, {0, 0, 4}, {2, 0, 0}}, arms{{1, 1, 1}, {0.1, 0, 0}, {0, 0, 0.1}};
  const WallForce sum = wall_force(surfaces, forces, arms);
  CHECK(sum.wrench.force_N == Vector3d(2, 0, 4));
  CHECK((sum.wrench.torque_N_m - Vector3d(0, -0.4 + 0.2, 0)).norm() < 1e-12);
  CHECK(sum.power_W == Approx(1));
}

TEST_CASE("Motion that is not finite counts as no work") {
  WallEnergy walls{WallLimits{}};
  const double nan = std::numeric_limits<double>::quiet_NaN();
  walls.record({{Vector3d(0, 0, 5), Vector3d::Zero()}, {}, 0});
  walls.observe(0.001, true, {Vector3d(nan, 0, 0), Vector3d(0, nan, 0)}, kDt, 0);
  CHECK(walls.generated_J() == 0);
  CHECK(walls.factor() == 0.5);
}

TEST_CASE("A stricter slew limit never gives the hand energy from a fixed wall") {
  // Once 1.4 to 1.8 J in 6 s at 100 and 30 N/s.
  for (const double slew_N_s : {2000.0, 500.0, 100.0, 30.0, 10.0}) {
    TrialDef def = metronome();
    def.settings.slew_limit_N_s = slew_N_s;
    const TrialResult r = run_trial(def);
    CAPTURE(slew_N_s, r.observed_mJ, r.peak_N);
    CHECK(r.energy_mJ < 0);
    CHECK(r.generated_mJ <= 1);
    CHECK(r.peak_N > 0.1);
  }
}

TEST_CASE("A fixed wall generates at most 1 mJ an episode at any delay") {
  for (int delay_ms = 0; delay_ms <= 300; delay_ms += delay_ms < 60 ? 5 : 40) {
    TrialDef def = metronome();
    def.delay_ms = delay_ms;
    const TrialResult r = run_trial(def);
    CAPTURE(delay_ms, r.energy_mJ, r.observed_mJ);
    CHECK(r.generated_mJ <= 1);
    if (delay_ms <= 30) CHECK(r.peak_N > 3);
    // The observer sees the energy within half a millijoule.
    CHECK(std::abs(r.observed_mJ - r.generated_mJ) < 0.5);
  }
}

TEST_CASE("A fixed wall is as stiff with a late touch model as with a fresh one") {
  // Once 0.03 N instead of 3.1 N at 200 ms, and half of the peak of a tap at 50 ms.
  const TrialResult tapped = run_trial(metronome()), pressed = run_trial(press());
  CHECK(pressed.hold_N > 2.5);
  CHECK(tapped.last_peak_N > 3);
  for (const int delay_ms : {10, 30, 50, 70, 100, 150, 200}) {
    TrialDef taps = metronome(), presses = press();
    taps.delay_ms = presses.delay_ms = delay_ms;
    const TrialResult tap = run_trial(taps), hold = run_trial(presses);
    CAPTURE(delay_ms, tap.generated_mJ, hold.generated_mJ);
    CHECK(hold.hold_N == Approx(pressed.hold_N).epsilon(0.01));
    CHECK(hold.hold_m == Approx(pressed.hold_m).epsilon(0.01));
    CHECK(tap.last_peak_N == Approx(tapped.last_peak_N).epsilon(0.03));
    CHECK(tap.deepest_m == Approx(tapped.deepest_m).epsilon(0.03));
    CHECK(tap.generated_mJ <= 1);
    CHECK(hold.generated_mJ <= 1);
    CHECK(tap.energy_mJ < 0);
  }
}

TEST_CASE("A wall that appears deep above a hand that presses on is stiff from there, without pushing it out") {
  for (const int delay_ms : {90, 120}) {
    TrialDef def = press();
    def.margin_late_m = 0;  // the simulation ignores that the tool renders late
    def.delay_ms = delay_ms;
    def.depth_m = 0.04;
    def.settings.transient_gain = 0;
    const TrialResult r = run_trial(def);
    CAPTURE(delay_ms, r.hold_m, r.observed_mJ);
    // Of a spring of 300 N/m that is 40 mm away, the wall holds what it needs at the depth at which it appeared.
    CHECK(r.hold_N == Approx(300 * (0.04 - r.hold_m)).epsilon(0.02));
    CHECK(r.hold_N > 2);
    CHECK(r.generated_mJ <= 1);
    CHECK(r.least_coupling > 0.9);
  }
}

TEST_CASE("A hand that presses while the force fades in gets back no more than it gave") {
  // The hand is outside when touch begins, and presses a part of the force. Once 24 mJ at 150 Hz and 150 ms.
  for (const double rate_Hz : {100.0, 150.0, 250.0, 1000.0})
    for (const double fade_s : {0.02, 0.05, 0.15, 0.5})
      for (const double top_m : {0.001, 0.0025, 0.005}) {
        TrialDef def;
        def.settings.rate_Hz = rate_Hz;
        def.settings.fade_s = fade_s;
        def.hand = {0.755, 56, 9.2};
        def.stiffness_N_m = 10000;
        def.top_m = top_m;
        const TrialResult r = run_trial(def);
        CAPTURE(rate_Hz, fade_s, top_m, r.energy_mJ, r.observed_mJ);
        CHECK(r.generated_mJ <= 1);
      }
}

TEST_CASE("A fixed wall generates at most 1 mJ an episode at any rate") {
  for (const double rate_Hz : {100.0, 120.0, 150.0, 250.0, 500.0, 1000.0, 4000.0}) {
    TrialDef def = metronome();
    def.settings.rate_Hz = rate_Hz;
    const TrialResult r = run_trial(def);
    CAPTURE(rate_Hz, r.energy_mJ, r.observed_mJ);
    CHECK(r.generated_mJ <= 1);
    if (rate_Hz >= 250) CHECK(r.energy_mJ < 0);
  }
}
