#include "haptic_node/safety/wall_energy.h"

#include "haptic_node/safety/motion_work.h"

namespace tactus::haptic {
namespace {

// As of the channel to bodies (passivity.cpp): an episode ends when the hand has been away for this time.
constexpr double kEpisodeGap_s = 0.2;
// Dissipated energy counts as credit up to this value, so that old friction does not pay for a new oscillation.
constexpr double kMaxCredit_J = 0.01;
// Part of the allowance with which a contact begins, and which is not returned: the default of generated_limit.
constexpr double kBegin_J = 0.0005;
// Largest share of the credit that one tick returns: the rest covers the error of the predicted motion. Design.
constexpr double kReturned = 0.9;
// A hand that rests or presses may be pushed by this much without a credit, so that a slow contact can begin: 1 N on 0.1 kg
// for a millisecond. Design.
constexpr double kStart_J = 1e-5;
// A force that is held for longer than this acts on a hand that opposes it, and only its change accelerates the hand. Such
// a loop lags so far that its walls also return the allowance. Design: twice the tick of 1 kHz.
constexpr double kSlow_s = 0.002;

double wall_work_J(const WallForce& f, const DeviceMotion& motion, double dt) {
  return work_J(f.plain(), motion, dt) - f.power_W * dt;
}

}  // namespace

void WallEnergy::reset() {
  commands_.clear();
  motion_ = {};
  motion_s_ = 0;
  balance_J_ = credit_J_ = 0;
  factor_ = 1;
  headroom_J_ = 0;
  apart_s_ = 0;
}

void WallEnergy::observe(double springs_J, bool pressed, const DeviceMotion& motion, double held_s, double appeared_J,
                         double relief_J) {
  time_s_ += held_s;
  const double span_s = motion.loop.immediate() ? held_s : motion.loop.span_s;
  const double given_J = wall_work_J(acting_in_tick(commands_, time_s_, held_s, motion.loop), motion, span_s);
  if (span_s > 0) motion_ = motion, motion_s_ = span_s;
  balance_J_ += relief_J - given_J;
  credit_J_ += relief_J - given_J;
  apart_s_ = pressed ? 0 : apart_s_ + held_s;
  if (apart_s_ > kEpisodeGap_s) balance_J_ = credit_J_ = 0;
  if (appeared_J > 0 && credit_J_ < appeared_J) {
    balance_J_ += appeared_J - credit_J_;
    credit_J_ = appeared_J;
  }
  credit_J_ = std::min(credit_J_, springs_J + kMaxCredit_J);
  const double available_J = std::max(0.0, credit_J_ + limits_.allowance_J);
  factor_ = springs_J > available_J ? available_J / springs_J : 1;
  headroom_J_ = std::max(0.0, credit_J_ + 0.5 * limits_.allowance_J - springs_J);
}

double WallEnergy::brake(const WallForce& next, const DeviceMotion& last, double dt) const {
  DeviceMotion during = last;
  double held_s = dt;
  if (!last.loop.immediate()) {
    held_s = std::max(dt, last.loop.period_s);
    const double scale = motion_s_ > 0 ? held_s / motion_s_ : 0;
    during = {scale * motion_.moved_m, scale * motion_.turned_rad, last.loop};
  }
  const bool slow = held_s > kSlow_s;
  // Part of the force that accelerates the hand: all of it, or its change.
  const Wrench all = next.plain();
  Wrench free = all;
  if (slow && !commands_.empty()) free = plus_scaled(all, commands_.entry(commands_.size() - 1).value.plain(), -1);
  const double accelerated_J =
      std::max(0.0, all.force_N.dot(free.force_N)) *
          twice_moved(held_s, limits_.device_mass_kg, limits_.device_damping_N_s_m) +
      std::max(0.0, all.torque_N_m.dot(free.torque_N_m)) *
          twice_moved(held_s, limits_.device_inertia_kg_m2, limits_.device_turn_damping_N_m_s_rad);
  const double moved_J = wall_work_J(next, during, held_s), given_J = moved_J + accelerated_J;
  const double credit_J = credit_J_ + (slow ? limits_.allowance_J : std::max(0.0, limits_.allowance_J - kBegin_J));
  const double left_J = std::max(0.0, moved_J > 0 && !slow ? kReturned * credit_J : credit_J + kStart_J);
  return given_J > left_J ? left_J / given_J : 1;
}

WallForce wall_force(std::span<const Surface> surfaces, std::span<const Eigen::Vector3d> forces,
                     std::span<const Eigen::Vector3d> arms) {
  WallForce sum;
  for (std::size_t i = 0; i < surfaces.size() && i < forces.size(); ++i) {
    if (surfaces[i].movable() || forces[i].isZero(0) || !forces[i].allFinite()) continue;
    const Eigen::Vector3d plain = without_tilt(surfaces[i], forces[i]), tilt = forces[i] - plain;
    sum.wrench.force_N += forces[i];
    sum.tilt.force_N += tilt;
    if (i < arms.size()) {
      sum.wrench.torque_N_m += arms[i].cross(forces[i]);
      sum.tilt.torque_N_m += arms[i].cross(tilt);
    }
    sum.power_W += plain.dot(surfaces[i].velocity_at(surfaces[i].point));
  }
  return sum;
}

}  // namespace tactus::haptic
