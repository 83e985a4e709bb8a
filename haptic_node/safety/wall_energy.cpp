#include "haptic_node/safety/wall_energy.h"

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
// The same limits as in safety.cpp: above them the device has jumped, and no work is counted.
constexpr double kMaxHandSpeed_m_s = 40, kMaxHandSpin_rad_s = 63;

double work_J(const WallForce& f, const DeviceMotion& motion, double dt) {
  const bool moved = motion.moved_m.allFinite() && motion.moved_m.norm() <= kMaxHandSpeed_m_s * dt;
  const bool turned = motion.turned_rad.allFinite() && motion.turned_rad.norm() <= kMaxHandSpin_rad_s * dt;
  return (moved ? f.wrench.force_N.dot(motion.moved_m) : 0) +
         (turned ? f.wrench.torque_N_m.dot(motion.turned_rad) : 0) - f.power_W * dt;
}

}  // namespace

void WallEnergy::reset() {
  commanded_ = {};
  credit_J_ = 0;
  factor_ = 1;
  apart_s_ = 0;
}

void WallEnergy::observe(double springs_J, bool pressed, const DeviceMotion& motion, double held_s, bool begins) {
  credit_J_ -= work_J(commanded_, motion, held_s);
  apart_s_ = pressed ? 0 : apart_s_ + held_s;
  if (apart_s_ > kEpisodeGap_s) credit_J_ = 0;
  if (begins) credit_J_ = std::max(credit_J_, springs_J);
  credit_J_ = std::min(credit_J_, springs_J + kMaxCredit_J);
  const double available_J = std::max(0.0, credit_J_ + limits_.allowance_J);
  factor_ = springs_J > available_J ? available_J / springs_J : 1;
}

double WallEnergy::brake(const WallForce& next, const DeviceMotion& last, double dt) const {
  const double accelerated_J = dt * dt * (next.wrench.force_N.squaredNorm() / limits_.device_mass_kg +
                                          next.wrench.torque_N_m.squaredNorm() / limits_.device_inertia_kg_m2);
  const double moved_J = work_J(next, last, dt), given_J = moved_J + accelerated_J;
  const double credit_J = credit_J_ + std::max(0.0, limits_.allowance_J - kBegin_J);
  const double left_J = std::max(0.0, moved_J > 0 ? kReturned * credit_J : credit_J + kStart_J);
  return given_J > left_J ? left_J / given_J : 1;
}

WallForce wall_force(std::span<const Surface> surfaces, std::span<const Eigen::Vector3d> forces,
                     std::span<const Eigen::Vector3d> arms) {
  WallForce sum;
  for (std::size_t i = 0; i < surfaces.size() && i < forces.size(); ++i) {
    if (surfaces[i].movable() || forces[i].isZero(0) || !forces[i].allFinite()) continue;
    sum.wrench.force_N += forces[i];
    if (i < arms.size()) sum.wrench.torque_N_m += arms[i].cross(forces[i]);
    sum.power_W += forces[i].dot(surfaces[i].velocity_at(surfaces[i].point));
  }
  return sum;
}

}  // namespace tactus::haptic
