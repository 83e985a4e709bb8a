// The energy account of fixed surfaces with reliefs: it contains all but the energy of the relief itself.
#include <catch2/catch.hpp>
#include <cmath>
#include <tactus/touch_model_t.hpp>
#include <tactus/touch_plane_t.hpp>

#include "haptic_node/safety/wall_energy.h"
#include "tests/haptic_node/support/tick.h"
#include "tests/haptic_node/support/trial.h"
#include "tests/haptic_node/support/waves.h"
#include "tests/haptic_node/support/world.h"

using namespace tactus;
using namespace tactus::haptic;
using namespace tactus::haptic::test;

TEST_CASE("The tilt by a relief is no part of the account, with the torque and for a surface that moves") {
  std::vector<Surface> surfaces(1);
  surfaces[0].effective_mass_kg = 1e10;
  surfaces[0].normal = Vector3d::UnitZ();
  surfaces[0].velocity = {1, 0, 2};
  surfaces[0].mapped.force_tilt = Vector3d(0.3, -0.1, 0);
  const Vector3d tilted = Vector3d(0.3, -0.1, 1).normalized(), friction(0.2, 0.5, 0), arm(0.1, 0.2, 0.3);
  const WallForce sum = wall_force(surfaces, std::vector{Vector3d(4 * tilted + friction)}, std::vector{arm});
  const Vector3d plain = 4 * Vector3d::UnitZ() + friction;
  CHECK((sum.wrench.force_N - (4 * tilted + friction)).norm() < 1e-12);
  CHECK((sum.plain().force_N - plain).norm() < 1e-12);
  CHECK((sum.plain().torque_N_m - arm.cross(plain)).norm() < 1e-12);
  CHECK(sum.power_W == Approx(plain.dot(Vector3d(1, 0, 2))));
}

TEST_CASE("Energy that a change of height puts into the springs is credited, and taken back") {
  WallEnergy walls{WallLimits{}};
  const DeviceMotion rests;
  walls.observe(0, true, rests, kDt, 0);
  // A bump of 2 mm passes under a hand that rests: 2 mJ in the springs.
  walls.observe(0.002, true, rests, kDt, 0, 0.002);
  CHECK(walls.factor() == 1);
  CHECK(walls.generated_J() == 0);
  walls.observe(0, true, rests, kDt, 0, -0.002);
  CHECK(walls.factor() == 1);
  // Without a bump the same springs are softened to the allowance.
  walls.observe(0.002, true, rests, kDt, 0);
  CHECK(walls.factor() == Approx(0.25));
}

TEST_CASE("A strict slew limit and coarse steps generate at most 1 mJ on a wall with a relief") {
  // Once 274 mJ in eight taps at 100 N/s: every spring of a relief was credited.
  for (const char* bump : {"normal", "height", "both"})
    for (const double slew_N_s : {2000.0, 300.0, 100.0, 30.0})
      for (const double step_N : {0.0, 0.5, 3.0}) {
        TrialDef def = metronome();
        def.taps = 8;
        def.relief_m = 0.0002;
        def.settings.bump = bump;
        def.settings.slew_limit_N_s = slew_N_s;
        def.force_step_N = step_N;
        const TrialResult r = run_trial(def);
        CAPTURE(bump, slew_N_s, step_N, r.energy_mJ, r.observed_mJ);
        CHECK(r.generated_mJ <= 1);
      }
}

TEST_CASE("The account of walls does not change how a relief feels in a stroke") {
  // A stroke with changing pressure, with the smallest and the largest allowance: the same forces to the bit.
  for (const char* bump : {"height", "normal", "both"})
    for (const double speed_m_s : {0.02, 0.1, 0.5}) {
      const auto stroke = [&](double generated_limit_J) {
        Settings s;
        s.bump = bump;
        s.generated_limit_J = generated_limit_J;
        s.energy_limit_J = 10, s.power_limit_W = 50;  // not the limits of energy
        Bench bench(s);
        bench.renderer.set_maps(waves(0.001));
        std::vector<Vector3d> forces;
        touch_model_t m;
        for (int ms = 0; ms < 3000; ++ms) {
          const double t = 1e-3 * ms, x = 0.05 * std::sin(speed_m_s / 0.05 * t);
          const double press_m = std::min(1.0, t / 0.2) * (0.003 + 0.001 * std::sin(2 * M_PI * 3 * t)) - 0.001;
          touch_plane_t p = plane(7, {x, 0, 0}, Vector3d::UnitZ(), 0.3);
          add_map(p);
          m = model(ms, {p});
          forces.push_back(bench.tick(ms, {x, 0, 0.005 - press_m}, &m).force_N);
        }
        return forces;
      };
      CAPTURE(bump, speed_m_s);
      CHECK(stroke(0.0005) == stroke(0.01));
    }
}
