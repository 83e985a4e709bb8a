// Penalty contact: within a thin shell around the surfaces a spring and a damper separate the bodies, so that forces
// are finite and grow from zero (Kim, Sung, Park 2005, section 3; Baraff and Witkin 1998 for the implicit form). The
// shell lies outside of the surfaces of the impulse solver, which stops bodies that cross it.
#pragma once

#include "sim_node/behaviour/impulse/contact_rows.h"

namespace tactus::sim::impulse {

// Acts at every point of a contact, so a face on a face is four times as stiff. A contact has at most four points at
// any resolution of the surfaces.
struct Penalty {
  double stiffness_N_m = 0;  // 0: no penalty
  double damping_N_s_m = 0;
  double thickness_m = 5e-4;
  // true: uses the force at the start of a step, which is stable only for short steps. false: uses the force at the
  // end of the step (backward Euler), which is stable for any step.
  bool is_explicit = false;
  // Speed at which a point that starts inside the shell, for example in the initial scene, is lifted out: its shell
  // grows from its gap. 0: immediately, so that the spring throws it.
  double rise_m_s = 0;
};

// Share of the shell over which damping increases to its full value. Immediate full damping would act like an impact
// on arrival (Hunt and Crossley 1975, equation 6 and figure 3). Design value: thin compared with the shell, so that
// the damper inside is linear.
inline constexpr double kDampingOnsetShare = 0.1;

// Spring and damper as a constraint of the step (Smith 2006, ODE manual 3.8.2).
struct SoftRow {
  double erp = 0;        // h k / (h k + d): share of the error corrected per step
  double cfm_m_s_N = 0;  // 1 / (h k + d)
};
inline SoftRow soft_row(double stiffness_N_m, double damping_N_s_m, double h_s) {
  const double sum = h_s * stiffness_N_m + damping_N_s_m;
  return {h_s * stiffness_N_m / sum, 1 / sum};
}

// Largest stiffness at which an explicit step neither gains energy nor diverges, N/m. mobility: of all points that
// press in one direction together, 1/kg (1/m for one point on a mass). From the poles of x'' = -(k x + d x')/m
// stepped as v += h a(x, v), x += h v: h^2 k + 2 h d < 4 m (Hairer, Lubich, Wanner 2006, I.1.4 and its exercises, for
// d = 0: h w < 2).
inline double max_explicit_stiffness_N_m(double mobility_1_kg, double damping_N_s_m, double h_s) {
  return (4 / mobility_1_kg - 2 * h_s * damping_N_s_m) / (h_s * h_s);
}

// Sets for each point the gap at which it presses, and for each contact whether its springs will stop it. Contacts
// that will cross the shell collide instead, with the restitution of their materials. velocity: at the start of the
// step. Call it after WarmStart::recall() and before collisions.
void set_penalty_shells(ContactRows& rows, const Penalty& penalty, const Velocities& velocity, double h_s);

// Sets the penalty force of each point of the rows. velocity: mean over the step before contact. Call it after
// min_speed_m_s is set.
void set_penalty_forces(ContactRows& rows, const Penalty& penalty, const Velocities& velocity, double h_s);

}  // namespace tactus::sim::impulse
