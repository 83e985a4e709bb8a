// Closed loops of hand, renderer and simulation with the delays of a bus between them.
#include <catch2/catch.hpp>
#include <deque>
#include <tactus/touch_model_t.hpp>

#include "haptic_node/devices/virtual_hand.h"
#include "tests/haptic_node/support/world.h"

using namespace tactus;
using namespace tactus::haptic;
using namespace tactus::haptic::test;

namespace {

// A body that moves along z on a spring and a weak damper, stepped at 1 kHz; the hand presses on it from above.
struct Body {
  double mass_kg, stiffness_N_m, damping_N_s_m;
  double z = 0, v = 0;

  void step(double force_N, double dt) {
    v += dt * (force_N - stiffness_N_m * z - damping_N_s_m * v) / mass_kg;
    z += dt * v;
  }
  double energy_J() const { return 0.5 * (mass_kg * v * v + stiffness_N_m * z * z); }
};

struct Run {
  double force_N = 0;          // at the end
  double max_motion_m_s = 0;   // of hand or body in the last half second
  int force_reversals = 0;     // changes between increase and decrease by more than 0.05 N, in total
  double energy_J = 0;         // given to the hand
};

// The hand moves to 1 cm beyond the surface within 0.3 s and stays. The touch model arrives delay_ms late, and the
// force of the tool acts on the body one step after it is sent. Only every every_ms-th model arrives.
Run press(std::optional<Body> body, double delay_ms, int every_ms = 1) {
  const Settings settings;
  VirtualHand hand(
      MonotoneCubic({0, 0.3}, {Vector3d(0, 0, 0.015), Vector3d(0, 0, -0.005)}, MonotoneCubic::Ends::kRest), false,
      {settings.hand_mass_kg, settings.hand_damping_Ns_m, settings.hand_stiffness_N_m});
  hand.begin(host_ms(0));
  Bench bench(settings);
  std::deque<touch_model_t> in_transit;
  double impulse = 0, applied_impulse = 0, extreme = 0;
  bool growing = true;
  Run run;
  for (int ms = 0; ms < 3000; ++ms) {
    if (body) body->step(-(impulse - applied_impulse) / 1e-3, 1e-3);
    applied_impulse = impulse;
    auto p = plane(7, {0, 0, body ? body->z : 0}, Vector3d::UnitZ());
    if (body) p.effective_mass_kg = static_cast<float>(body->mass_kg);
    if (body) p.velocity_m_s = to_vec3f(Vector3d(0, 0, body->v));
    in_transit.push_back(model(ms, {p}));
    const DeviceState state = hand.read(host_ms(ms));
    const bool due = in_transit.size() > static_cast<std::size_t>(delay_ms);
    const touch_model_t* fresh = due && ms % every_ms == 0 ? &in_transit.front() : nullptr;
    bench.arrival = host_ms(ms);  // an intended low rate does not count as a loss
    const auto& out = bench.tick(ms, state.position, fresh);
    if (due) in_transit.pop_front();
    hand.write(out.force_N);
    if (!out.state.constraints.empty()) impulse = out.state.constraints[0].impulse_N_s.z;
    run.force_N = out.force_N.z();
    run.energy_J = out.state.energy_J;
    if (growing ? run.force_N < extreme - 0.05 : run.force_N > extreme + 0.05) {
      growing = !growing;
      ++run.force_reversals;
      extreme = run.force_N;
    }
    extreme = growing ? std::max(extreme, run.force_N) : std::min(extreme, run.force_N);
    if (ms >= 2500)
      run.max_motion_m_s = std::max({run.max_motion_m_s, state.velocity.norm(), body ? std::abs(body->v) : 0});
  }
  return run;
}

}  // namespace

TEST_CASE("A hand on a stiff wall comes to rest with touch models that are 1 to 3 ms late") {
  const double delay_ms = GENERATE(1, 2, 3);
  const Run run = press(std::nullopt, delay_ms);
  CHECK(run.max_motion_m_s < 1e-9);
  CHECK(run.force_reversals <= 2);  // at most one overshoot
  // The hand received no energy: it spent the work of its 1 cm against the wall.
  CHECK(run.energy_J < -0.5 * run.force_N * run.force_N / 1000 * 0.99);
}

TEST_CASE("A hand on a body of any mass comes to rest with touch models that are 1 to 3 ms late") {
  const double delay_ms = GENERATE(1, 2, 3);
  const double mass_kg = GENERATE(0.002, 0.01, 0.05, 0.2, 1.0, 5.0);
  CAPTURE(delay_ms, mass_kg);
  // On a spring with a twentieth of critical damping and a resonance of at most 100 rad/s: no coupling can damp
  // motion that is faster than the loop delay of up to 5 ms.
  const double stiffness_N_m = std::min(500.0, 1e4 * mass_kg);
  const Run run = press(Body{mass_kg, stiffness_N_m, 0.1 * std::sqrt(stiffness_N_m * mass_kg)}, delay_ms);
  // The heaviest rings by itself, at 10 rad/s and 0.5 1/s: after 2.2 s still with a third of its first speed.
  CHECK(run.max_motion_m_s < 0.005);
  CHECK(run.energy_J < 0.02);
  CHECK(run.force_N > 0.02);
}

TEST_CASE("A pushed light body gains no energy from the delays") {
  // No spring holds it: pushed down by the hand it leaves once, at about the speed of the hand.
  const double delay_ms = GENERATE(1, 2, 3);
  const Run run = press(Body{0.02, 0, 0}, delay_ms);
  CHECK(run.force_N == Approx(0).margin(1e-6));
  CHECK(run.force_reversals <= 3);
  CHECK(run.energy_J < 1e-4);
}

TEST_CASE("A hand on a body of any mass comes to rest with touch models at 30 Hz") {
  const double mass_kg = GENERATE(0.05, 0.1, 0.2);
  CAPTURE(mass_kg);
  const Run run = press(Body{mass_kg, 500, 0.1 * std::sqrt(500 * mass_kg)}, 1, 33);
  CHECK(run.max_motion_m_s < 0.005);
  CHECK(run.energy_J < 0.001);
  CHECK(run.force_N > 0.02);
}
