#include "haptic_node/rendering/coupling.h"

#include <cmath>

namespace tactus::haptic {
namespace {

constexpr double kFixed_kg = 1e9;
// Share of the largest passive stiffness that is used. Simulated taps of hands of 0.05 to 2 kg with lags of 1 to 50 ms
// generate less than 1 mJ with it (tests/bench/haptic_node/passivity_table).
constexpr double kPassiveShare = 0.8;
// As free_lag_N_s_m, for a movable body, which is pushed along: 0.02 m2/s.
constexpr double kFreeBodyLag_N_s_m = 0.02;
// Ratio of B to K tau. A delay takes K tau from the damping of slow motion; the additional half covers faster
// motion.
constexpr double kLead = 1.5;
// The damper itself is late: this factor keeps B tau / m below its stability bound, relative to the bound on K
// tau^2 / m.
constexpr double kMaxLead = 3;
// Loop delays up to this value are those of an undisturbed bus, for which the other limits suffice. Design: a
// step, a tick and a touch model of one or two milliseconds.
constexpr double kUndisturbed_s = 0.004;
// From this delay on, the delay is a large part of a period of the pressing hand (10 Hz), and the coupling is
// reduced further. Design.
constexpr double kLongDelay_s = 0.1;
// The damping increases with the depth up to this value: 0.1 N per tick at 0.1 m/s, 5 N s/m and 1 kHz. Design.
constexpr double kSoftDepth_m = 0.0005;

double squared(double x) { return x * x; }

}  // namespace

Gains coupling_gains(double surface_stiffness_N_m, double surface_damping_N_s_m, double body_mass_kg,
                     double loop_delay_s, double period_s, const CouplingLimits& limits, double device_delay_s) {
  const bool fixed = body_mass_kg >= kFixed_kg;
  const double rho = fixed ? 1 : body_mass_kg / (body_mass_kg + limits.device_mass_kg);
  const double reduced_kg = rho * limits.device_mass_kg;
  const double b = limits.device_damping_N_s_m, held = std::max(b, limits.held_damping_N_s_m);
  const double max_damping = std::clamp(b - limits.free_lag_N_s_m, 0.0, b / 2);
  const double of_device = held * rho * rho, lag_s = period_s / 2 + device_delay_s;

  Gains g;
  g.stiffness_N_m = std::min(
      {surface_stiffness_N_m, limits.stiffness_limit_N_m, kPassiveShare * (b - max_damping) / lag_s});
  // Large damping would drag a light body faster than the loop can measure.
  double damping_limit = max_damping;
  if (!fixed) {
    damping_limit = std::min(damping_limit, kMaxLead * limits.mass_factor * body_mass_kg / loop_delay_s);
    g.stiffness_N_m =
        std::min(g.stiffness_N_m, limits.mass_factor * body_mass_kg /
                                      (squared(loop_delay_s) * (1 + squared(loop_delay_s / kLongDelay_s))));
    // Like a lag of the device, a small part needs no damper.
    const double compensated = std::min(std::max(max_damping, kFreeBodyLag_N_s_m),
                                        kMaxLead * limits.mass_factor * body_mass_kg / loop_delay_s);
    const double disturbed_s = loop_delay_s - kUndisturbed_s;
    if (disturbed_s > 0) g.stiffness_N_m = std::min(g.stiffness_N_m, compensated / (2 * kLead * disturbed_s));
  }
  const double critical = (max_damping + of_device) / (2 * limits.damping_ratio);
  g.stiffness_N_m = std::min(g.stiffness_N_m, critical * critical / reduced_kg);
  const double needed = 2 * limits.damping_ratio * std::sqrt(g.stiffness_N_m * reduced_kg) - of_device;
  damping_limit = std::max(damping_limit, std::min(max_damping, needed));
  const double lead = std::max(g.stiffness_N_m * lag_s / kPassiveShare,
                               fixed ? 0.0 : kLead * g.stiffness_N_m * loop_delay_s);
  g.damping_N_s_m = std::clamp(std::max({needed, lead, surface_damping_N_s_m}), 0.0, damping_limit);
  return g;
}

void LoopDelay::advance(double age_s, double dt) {
  peak_s_ *= std::exp(-dt / kPeakDecay_s);
  const double counted_s = std::clamp(age_s, 0.0, std::min(kMaxAge_s, 2 * mean_s_ + kShortGap_s));
  mean_s_ += (1 - std::exp(-dt / kMean_s)) * (counted_s - mean_s_);
  held_s_ = std::max(mean_s_, held_s_ * std::exp(-dt / kHeldDecay_s));
}

void LoopDelay::reduce(double by_s) {
  for (double* s : {&peak_s_, &mean_s_, &held_s_}) *s = std::max(0.0, *s - by_s);
}

Gains rendered_gains(const Surface& s, const CouplingFactors& factors, double pressed_m) {
  // Keeps the damping ratio when the stiffness is lowered.
  const double share = s.movable() ? factors.bodies : factors.walls;
  return {share * s.coupling_stiffness_N_m,
          std::sqrt(share) * std::min(1.0, pressed_m / kSoftDepth_m) * s.coupling_damping_N_s_m};
}

void coupling_forces(std::span<const Surface> surfaces, const Eigen::Vector3d& shift_m,
                     const Eigen::Vector3d& device_velocity, bool slipping, std::span<Eigen::Vector3d> forces,
                     const CouplingFactors& factors) {
  double cone_m = 0;
  const auto friction = [&](const Surface& s) { return slipping ? s.friction_dynamic : s.friction_static; };
  for (const Surface& s : surfaces) cone_m += s.depth_m * friction(s);
  for (std::size_t i = 0; i < surfaces.size() && i < forces.size(); ++i) {
    const Surface& s = surfaces[i];
    const auto [K, B] = rendered_gains(s, factors, s.depth_m);
    forces[i].setZero();
    if (s.depth_m <= 0) continue;
    const Eigen::Vector3d relative = device_velocity - s.velocity_at(s.point);
    const double normal_speed = relative.dot(s.normal);
    const double normal_force = std::max(0.0, K * s.depth_m - B * normal_speed);
    forces[i] = normal_force * s.normal;
    if (cone_m <= 0) continue;
    const double share = s.depth_m * friction(s) / cone_m;
    Eigen::Vector3d tangential = share * K * shift_m;
    if (!slipping) tangential -= share * B * (relative - normal_speed * s.normal);
    const double limit = friction(s) * normal_force, size = tangential.norm();
    if (size > limit) tangential *= limit / size;
    forces[i] += tangential;
  }
}

}  // namespace tactus::haptic
