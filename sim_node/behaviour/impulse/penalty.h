// Penalty contact: within a thin shell around the surfaces a spring and a damper keep them apart, so that forces
// are finite and grow from zero (Kim, Sung, Park 2005, section 3; Baraff and Witkin 1998 for the implicit form).
// The shell lies outside of where the impulse solver lets surfaces meet: what runs through it is stopped there.
#pragma once

#include "sim_node/behaviour/impulse/contact_rows.h"

namespace tactus::sim::impulse {

// At every point of a contact, so a face on a face is four times as stiff: points are at most four, however fine
// the surfaces are divided.
struct Penalty {
  double stiffness_N_m = 0;  // 0: no penalty
  double damping_N_s_m = 0;
  double thickness_m = 5e-4;
  // The force is that of the start of a step: simple, and stable only while the step is short enough. Else it is
  // that of the end of the step (backward Euler), which is stable at any step.
  bool is_explicit = false;
  // What is found inside of the shell without having come in, as where a scene begins, is lifted out so fast: the
  // shell grows there from the gap that it has. 0: at once, as the spring throws it.
  double rise_m_s = 0;
};

// Share of the shell over which the damper sets in: a damper that began at once would strike what arrives
// (Hunt and Crossley 1975, equation 6 and figure 3); design: thin beside the shell, so that inside it the damper
// is linear.
inline constexpr double kDamperSetsIn = 0.1;

// Spring and damper as a constraint of the step (Smith 2006, ODE manual 3.8.2).
struct SoftRow {
  double erp = 0;        // h k / (h k + d): share of the error that a step takes back
  double cfm_m_s_N = 0;  // 1 / (h k + d)
};
inline SoftRow soft_row(double stiffness_N_m, double damping_N_s_m, double h_s) {
  const double sum = h_s * stiffness_N_m + damping_N_s_m;
  return {h_s * stiffness_N_m / sum, 1 / sum};
}

// Largest stiffness at which an explicit step neither gains energy nor diverges, N/m; mobility: of all points that
// press in one direction together, 1/kg (1/m for one point on a mass). From the poles of x'' = -(k x + d x')/m
// stepped as v += h a(x, v), x += h v: h^2 k + 2 h d < 4 m (Hairer, Lubich, Wanner 2006, I.1.4 and its exercises,
// for d = 0: h w < 2).
inline double stiffest_explicit(double mobility_1_kg, double damping_N_s_m, double h_s) {
  return (4 / mobility_1_kg - 2 * h_s * damping_N_s_m) / (h_s * h_s);
}

// Says of each point from which gap on it presses, and of each contact whether its springs will stop it: those
// that are run through collide instead, with the restitution of their materials. velocity: at the start of the
// step. After what was remembered of the step before has been recalled, before collisions.
void shield(ContactRows& rows, const Penalty& penalty, const Velocities& velocity, double h_s);

// Sets what penalty asks of each point of the rows. velocity: mean over the step before contact. After
// least_speed_m_s.
void press(ContactRows& rows, const Penalty& penalty, const Velocities& velocity, double h_s);

}  // namespace tactus::sim::impulse
