#include "haptic_node/safety/tdpa.h"

#include <algorithm>

namespace tactus::haptic {
namespace {

// The vector without this share of its part along the motion, if that part does work on the hand.
Eigen::Vector3d without_push(const Eigen::Vector3d& push, const Eigen::Vector3d& moved, double share) {
  const double along = push.dot(moved);
  return along > 0 ? Eigen::Vector3d(push - share * along / moved.squaredNorm() * moved) : push;
}

}  // namespace

void TimeDomainPassivity::observe(double work_J) {
  in_J_ += std::max(0.0, -work_J);
  out_J_ += std::max(0.0, work_J);
}

void TimeDomainPassivity::forget_credit() { out_J_ = std::max(out_J_, received_J_); }

double TimeDomainPassivity::given_J(const Wrench& wrench, const DeviceMotion& during, double held_s) {
  return std::max(0.0, work_J({wrench.force_N, Eigen::Vector3d::Zero()}, during, held_s)) +
         std::max(0.0, work_J({Eigen::Vector3d::Zero(), wrench.torque_N_m}, during, held_s));
}

Wrench TimeDomainPassivity::control(const Wrench& wanted, const DeviceMotion& during, double held_s, double received_J) {
  received_J_ = std::max(received_J_, received_J);
  damping_N_s_m_ = 0;
  const double force_J = given_J({wanted.force_N, Eigen::Vector3d::Zero()}, during, held_s);
  const double torque_J = given_J({Eigen::Vector3d::Zero(), wanted.torque_N_m}, during, held_s);
  const double coming_J = force_J + torque_J, excess_J = out_J_ + coming_J - received_J_;
  if (!(held_s > 0) || !(coming_J > 0) || !(excess_J > 0)) return wanted;
  const double distance_m = during.moved_m.norm();
  if (torque_J == 0 && distance_m < kMinSpeed_m_s * held_s) return wanted;
  const double share = std::min(1.0, excess_J / coming_J);
  if (distance_m > 0) damping_N_s_m_ = share * force_J * held_s / (distance_m * distance_m);
  return {without_push(wanted.force_N, during.moved_m, share), without_push(wanted.torque_N_m, during.turned_rad, share)};
}

}  // namespace tactus::haptic
