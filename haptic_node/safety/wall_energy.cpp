#include "haptic_node/safety/wall_energy.h"

namespace tactus::haptic {
namespace {

// As of the channel to bodies (passivity.cpp): an episode ends when the hand has been away for this time.
constexpr double kEpisodeGap_s = 0.2;
// Dissipated energy counts as credit up to this value, so that old friction does not pay for a new oscillation.
constexpr double kMaxCredit_J = 0.01;
// A wall that lost its stiffness regains it while the hand stays, at half of the rate of bodies. Design: 0.25 mJ in the
// 2.5 s of a long press, beside the allowance of 0.5 mJ.
constexpr double kRefill_W = 0.0001;
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
  if (available_J() < springs_J) credit_J_ += kRefill_W * held_s;
  credit_J_ = std::min(credit_J_, springs_J + kMaxCredit_J);
  factor_ = springs_J > available_J() ? available_J() / springs_J : 1;
}

double WallEnergy::brake(const WallForce& next, const DeviceMotion& last, double dt) const {
  const double accelerated_J = dt * dt * (next.wrench.force_N.squaredNorm() / limits_.device_mass_kg +
                                          next.wrench.torque_N_m.squaredNorm() / limits_.device_inertia_kg_m2);
  const double given_J = work_J(next, last, dt) + accelerated_J;
  return given_J > available_J() ? available_J() / given_J : 1;
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
