// The virtual coupling between proxy and device (Colgate, Stanley and Brown 1995): how stiff and how damped it may
// be for each surface, and the force of each surface on the hand.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <span>

#include "haptic_node/contact/surfaces.h"

namespace tactus::haptic {

struct CouplingLimits {
  double stiffness_limit_N_m = 2000;
  double mass_factor = 0.1;
  double damping_ratio = 0.7;
  double device_mass_kg = 0.1;
  double device_damping_N_s_m = 10;
};

struct Gains {
  double stiffness_N_m = 0;
  double damping_N_s_m = 0;
};

// Device (mass M, damper b to ground) and body (mass m, seen along the normal) joined by spring K and damper B
// move against each other with reduced mass mu = M m / (M + m), and are damped by B + b rho^2, rho = m / (M + m).
// Then
//   B <= b / 2                                  so that half of what the device dissipates is left for sampling
//   K <= 2 (b - B) / T                          passive for any hand (Colgate and Schenkel 1997)
//   K <= factor * m / tau^2                     a body that moves answers only after the loop delay tau; less when
//                                               tau is beyond what hands do
//   B >= 1.5 K tau, B <= 3 factor * m / tau     to motion of frequency w, a spring that is tau late is a damper of
//                                               -K sin(w tau) / w: it drives the body's own swing. The damper
//                                               gives back what the spring takes; both are late, so K falls where
//                                               B may not grow
//   (B + b rho^2) / (2 sqrt(K mu)) >= ratio     by more damping first, then by less stiffness
// body_mass_kg of 1e9 and above: does not move, and then the rules with tau are void.
Gains coupling_gains(double surface_stiffness_N_m, double surface_damping_N_s_m, double body_mass_kg,
                     double loop_delay_s, double period_s, const CouplingLimits& limits);

// How long it takes from a movement of the tool until the motion of the body that it causes is felt: the age of
// the touch model when it arrives, at worst lately, or its mean age in use where that is more, plus one step of
// the world and one tick. A model that is held for a time T acts as one that is T/2 late (Franklin, Powell and
// Workman 1998, on the zero-order hold), which is the mean age: so thin models count as late, lost ones a little.
// A single long gap is no rate: it counts in part, and is up to the controller of passivity.
class LoopDelay {
 public:
  // Age of a touch model that is used now, s.
  void observe(double age_s) { peak_s_ = std::max(peak_s_, std::min(age_s, kLongest_s)); }
  // Once a tick, with the age of the model in use, s: the worst is forgotten slowly, so that the stiffness does
  // not flicker.
  void pass(double age_s, double dt);
  // From now on models are held back on purpose by so much less: that part of what was learnt is over at once.
  void relieve(double by_s);
  double value_s(double step_s, double period_s) const { return std::max(peak_s_, held_s_) + step_s + period_s; }

 private:
  static constexpr double kForget_s = 1;     // time constant
  static constexpr double kLongest_s = 0.1;  // beyond, the touch model counts as lost anyway
  static constexpr double kMean_s = 0.5;     // time constant of the mean; design: many models of 30 Hz
  static constexpr double kHold_s = 5;  // and in which it is forgotten, so that losses do not sway the stiffness
  static constexpr double kShortGap_s = 0.004;
  double peak_s_ = 0, mean_s_ = 0, held_s_ = 0;
};

// The gains of a surface as they are felt: the damper grows with the depth to which the tool is pressed (after
// Hunt and Crossley 1975) up to half a millimetre, where it is as the gains say, so the force begins and ends at
// zero, however fast the hand is. factor: on the stiffness to what moves, and its root on the damping.
Gains felt_gains(const Surface& s, double factor, double pressed_m);

// Force of each surface on the hand, N, into `forces`: normal, never pulling; tangential along the proxy's shift
// and, while it sticks, against the motion over the surface, within the cone of friction, by its felt gains.
// Realtime-safe: yes.
void coupling_forces(std::span<const Surface> surfaces, const Eigen::Vector3d& shift_m,
                     const Eigen::Vector3d& device_velocity, bool slipping, std::span<Eigen::Vector3d> forces,
                     double factor = 1);

}  // namespace tactus::haptic
