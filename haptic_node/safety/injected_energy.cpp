#include "haptic_node/safety/injected_energy.h"

#include <algorithm>

#include "haptic_node/safety/hand_limits.h"

namespace tactus::haptic {
namespace {

// As of walls (wall_energy.cpp): an episode ends after this time without force, and dissipated energy counts as credit up to
// this value, so that old friction does not pay for a new oscillation.
constexpr double kDisplayGap_s = 0.2;
constexpr double kMaxDisplayCredit_J = 0.01;
// Shares of the credit and of the allowance that one tick may use: the rest covers the error of the predicted motion. Design.
constexpr double kUsedCredit = 0.9, kUsedAllowance = 0.5;
// The rule of the coupling, K <= 0.8 (b - B) / (T/2 + delay) with a damper B of at most b/2 (rendering/coupling.cpp): the rest
// of b is free.
constexpr double kRuleShare = 0.8, kFreeShare = 0.5;

bool is_zero(const Wrench& w) { return w.force_N.isZero(0) && w.torque_N_m.isZero(0); }

}  // namespace

void InjectedEnergy::reset() {
  const InjectedLimits limits = limits_;
  *this = InjectedEnergy(limits);
}

double InjectedEnergy::free_damping_N_s_m(double held_s, double delay_s) const {
  return std::max(0.0, kFreeShare * limits_.device_damping_N_s_m -
                           limits_.stiffness_limit_N_m * (held_s / 2 + delay_s) / kRuleShare);
}

void InjectedEnergy::observe(const Wrench& displayed, const Wrench& computed, const DeviceMotion& motion, double span_s,
                             double stored_J, double dt) {
  apart_s_ = is_zero(displayed) && is_zero(computed) ? apart_s_ + dt : 0;
  if (apart_s_ > kDisplayGap_s) {
    // Motion in free space is no credit for the next contact.
    const double apart_s = apart_s_;
    reset();
    apart_s_ = apart_s;
    return;
  }
  if (!(span_s > 0)) return;
  motion_ = motion, motion_s_ = span_s;
  const double displayed_J = work_J(displayed, motion, span_s);
  displayed_J_ += displayed_J;
  computed_J_ += work_J(computed, motion, span_s);
  const double gained_J = std::max(0.0, computed_J_ - max_computed_J_);
  max_computed_J_ += gained_J;
  max_stored_J_ = std::max(max_stored_J_, stored_J);
  const bool moved = motion.moved_m.allFinite() && motion.moved_m.norm() <= kMaxHandSpeed_m_s * span_s;
  const double hold_s = motion.loop.immediate() ? span_s : motion.loop.period_s;
  const double lost_J =
      moved ? free_damping_N_s_m(hold_s, motion.loop.delay_s) * motion.moved_m.squaredNorm() / span_s : 0;
  const double before_J = credit_J_ - displayed_J + gained_J;
  credit_J_ = std::min(before_J + lost_J, std::max(before_J, max_stored_J_ + kMaxDisplayCredit_J));
  dissipated_J_ += std::max(0.0, credit_J_ - before_J);
  credit_J_ = std::min(credit_J_, max_stored_J_ + kMaxDisplayCredit_J);
}

double InjectedEnergy::brake(const Wrench& displayed, const Wrench& computed, bool same, double held_s) {
  same_ = same_ && same;
  if (same_) return 1;
  const double scale = motion_s_ > 0 ? held_s / motion_s_ : 0;
  const DeviceMotion during{scale * motion_.moved_m, scale * motion_.turned_rad, motion_.loop};
  const double accelerated_J =
      displayed.force_N.squaredNorm() * twice_moved(held_s, limits_.device_mass_kg, limits_.device_damping_N_s_m) +
      displayed.torque_N_m.squaredNorm() *
          twice_moved(held_s, limits_.device_inertia_kg_m2, limits_.device_turn_damping_N_m_s_rad);
  const double given_J = work_J(displayed, during, held_s) + accelerated_J;
  // The computed force may do this much more than the most so far, and the display with it.
  const double granted_J = std::max(0.0, computed_J_ + work_J(computed, during, held_s) - max_computed_J_);
  const double left_J = std::max(0.0, kUsedCredit * credit_J_ + kUsedAllowance * limits_.allowance_J) + granted_J;
  return given_J > left_J ? left_J / given_J : 1;
}

double InjectedEnergy::injected_J() const {
  return std::clamp(displayed_J_ - max_computed_J_, 0.0, kMaxReported_J);
}

}  // namespace tactus::haptic
