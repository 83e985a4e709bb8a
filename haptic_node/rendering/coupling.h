// The virtual coupling between proxy and device (Colgate, Stanley and Brown 1995): the stiffness and damping that
// each surface may have, and the force of each surface on the hand.
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
  // Least damping of device and holding hand together. It counts for the damping ratio only, because a device must
  // also be stable without a hand.
  double held_damping_N_s_m = 0;
  // A spring that lags by L generates at most K L times the integral of the squared speed, 0.005 m2/s for a fast tap. K L up
  // to this value needs no damper: 0.25 mJ.
  double free_lag_N_s_m = 0.05;
};

struct Gains {
  double stiffness_N_m = 0;
  double damping_N_s_m = 0;
};

// Device (mass M, damper b to ground) and body (mass m, seen along the normal) are joined by spring K and damper
// B. They move against each other with reduced mass mu = M m / (M + m), damped by B + b rho^2, rho = m / (M + m).
// The force is computed from a state that is device_delay old when it acts, and is held for a period T, so it lags by
// L = T / 2 + device_delay. The limits:
//   B <= b / 2, B <= b - 0.05 N s/m             half of the dissipation of the device is left for the lag; a nearly
//                                               undamped device gets no damper
//   K <= 0.8 (b - B) / L                        passive for any hand (Colgate and Schenkel 1997, with a delay: Gil et
//                                               al. 2009); 0.8 leaves dissipation for fast motion
//   B >= 1.25 K L                               for slow motion, a spring that lags by L is a damper of -K L
//   K <= factor * m / tau^2                     a moving body answers only after the loop delay tau; lower when
//                                               tau is long compared with the motion of hands
//   B >= 1.5 K tau, B <= 3 factor * m / tau     for motion of frequency w, a spring that is tau late is a damper
//   of
//                                               -K sin(w tau) / w and drives the oscillation of the body. The
//                                               damper returns the energy that the spring takes; both are late, so
//                                               K decreases where B cannot increase
//   (B + h rho^2) / (2 sqrt(K mu)) >= ratio     first by more damping, then by less stiffness; h: the larger one of b
//                                               and of the damping with a holding hand
// body_mass_kg of 1e9 and above means a fixed body; the limits with tau then do not apply. loop_delay_s: tau, with the
// lag of the device; period_s: T, > 0, the longer one of the periods of the tick and of the device; device_delay_s: from
// the measurement of a state to the effect of its force, without the hold.
Gains coupling_gains(double surface_stiffness_N_m, double surface_damping_N_s_m, double body_mass_kg,
                     double loop_delay_s, double period_s, const CouplingLimits& limits, double device_delay_s = 0);

// Least damping of a hand that holds a stylus: the lowest of fifteen people (Fu and Cavusoglu 2012, table III, as
// others quote it).
inline constexpr double kHeldDamping_N_s_m = 3.7;

// Factors of the passivity controller on the stiffness, 0 .. 1, to movable bodies and to walls.
struct CouplingFactors {
  CouplingFactors(double to_bodies = 1, double to_walls = 1) : bodies(to_bodies), walls(to_walls) {}
  double bodies, walls;
};

// Estimates the loop delay: the time from a movement of the tool until the resulting motion of the body is felt.
// It is the recent peak of the age of an arriving touch model, or the mean age in use if that is larger, plus one
// simulation step and one tick. A model that is held for a time T acts as if it were T/2 late (Franklin, Powell
// and Workman 1998, on the zero-order hold). This is its mean age, so a low model rate counts as a delay and lost
// models count a little. A single long gap is not a rate: it counts in part, and the passivity controller handles
// the rest.
class LoopDelay {
 public:
  // Age of a touch model that is used now, s.
  void observe(double age_s) { peak_s_ = std::max(peak_s_, std::min(age_s, kMaxAge_s)); }
  // Call once per tick with the age of the model in use, s. The peak decays slowly, so that the stiffness does not
  // flicker.
  void advance(double age_s, double dt);
  // An intended delay of the models is now shorter by by_s: subtracts it from the estimate immediately.
  void reduce(double by_s);
  double value_s(double step_s, double period_s) const { return std::max(peak_s_, held_s_) + step_s + period_s; }

 private:
  static constexpr double kPeakDecay_s = 1;  // time constant
  static constexpr double kMaxAge_s = 0.1;   // the touch model counts as lost beyond this
  static constexpr double kMean_s = 0.5;     // time constant of the mean; design: many models at 30 Hz
  static constexpr double kHeldDecay_s =
      5;  // time constant of its decay, so that losses do not modulate the stiffness
  static constexpr double kShortGap_s = 0.004;
  double peak_s_ = 0, mean_s_ = 0, held_s_ = 0;
};

// The gains of a surface as rendered. The damping increases with the depth of the tool (after Hunt and Crossley
// 1975) up to half a millimetre, where it reaches its full value, so the force begins and ends at zero at any
// speed of the hand. The square root of a factor applies to the damping.
Gains rendered_gains(const Surface& s, const CouplingFactors& factors, double pressed_m);

// Computes the force of each surface on the hand, N, into `forces`. The normal part never pulls. The tangential
// part acts along the shift of the proxy and, while it sticks, against the motion over the surface; it stays
// within the friction cone and uses the rendered gains. Realtime-safe: yes.
void coupling_forces(std::span<const Surface> surfaces, const Eigen::Vector3d& shift_m,
                     const Eigen::Vector3d& device_velocity, bool slipping, std::span<Eigen::Vector3d> forces,
                     const CouplingFactors& factors = {});

}  // namespace tactus::haptic
