// The world of an episode of touch: a wall, a body on a spring, or a body on a table, and the touch model of it. Pure.
#pragma once

#include <algorithm>
#include <tactus/touch_applied_t.hpp>
#include <tactus/touch_model_t.hpp>

#include "tests/haptic_node/support/episode.h"
#include "tests/haptic_node/support/world.h"

namespace tactus::haptic::test {

inline constexpr double kStep_s = 1e-3, kTool_m = 0.005;
// The body is on a spring so that it can be pressed; the damper removes its oscillation within seconds.
inline constexpr double kBodySpring_N_m = 500, kBodyDamper_Ns_m = 0.5;
// Pushed along a table: friction of wood.
inline constexpr double kTableFriction = 0.3, kGravity_m_s2 = 9.81;

inline Vector3d place(double z) { return {0, 0, z}; }

struct EpisodeWorld {
  double mass_kg = 0, stiffness_N_m = 1000;  // of the body (0: a wall), and of its surface
  bool slides = false;                       // on a table; otherwise on a spring
  double z = 0, v = 0, impulse = 0, energy_J = 0;  // of the body, and the impulse and energy that it received

  // One step of 1 ms with this force of the hand on the body.
  void step(double force_N) {
    const double m = mass_kg;
    if (m <= 0) return;
    if (slides) {
      v += kStep_s * force_N / m;
      v -= std::clamp(v, -kTableFriction * kGravity_m_s2 * kStep_s, kTableFriction * kGravity_m_s2 * kStep_s);
    } else {
      v += kStep_s * (force_N - kBodySpring_N_m * z - kBodyDamper_Ns_m * v) / m;
    }
    z += kStep_s * v;
    impulse += force_N * kStep_s;
    energy_J += force_N * v * kStep_s;  // this step moves the body by v dt
  }
  touch_model_t model_at(int ms) const {
    auto p = plane(7, place(z), Vector3d::UnitZ());
    p.stiffness_N_m = static_cast<float>(stiffness_N_m);
    if (mass_kg > 0) p.effective_mass_kg = static_cast<float>(mass_kg);
    p.velocity_m_s = to_vec3f(place(v));
    touch_model_t m = model(ms, {p});
    touch_applied_t a{};
    a.contact_id = 7;
    a.impulse_N_s = to_vec3(place(impulse));
    a.energy_J = energy_J;
    m.applied.push_back(a);
    m.applied_count = 1;
    return m;
  }
};

}  // namespace tactus::haptic::test
