#include "haptic_node/safety/safety.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "haptic_node/devices/device.h"
#include "haptic_node/safety/hand_limits.h"

namespace tactus::haptic {
namespace {

// A late tick must not cause a jump of the force: it counts as two ticks at most.
constexpr double kMaxSlewTicks = 2;

// Share of the workspace radius over which the force goes to zero. Design: 0.2 m of 2 m take 0.2 s at a hand speed
// of 1 m/s.
constexpr double kWorkspaceEdge = 0.1;

Eigen::Vector3d clamped(const Eigen::Vector3d& v, double limit) {
  const double size = v.norm();
  return size > limit ? Eigen::Vector3d(v * (limit / size)) : v;
}

// The wanted vector, scaled down to the part of `last` along it plus `rise`. A part of `last` across it ends at once.
Eigen::Vector3d risen(const Eigen::Vector3d& wanted, const Eigen::Vector3d& last, double rise) {
  const double size = wanted.norm();
  return size > 0 ? clamped(wanted, std::max(0.0, last.dot(wanted) / size) + rise)
                  : Eigen::Vector3d(Eigen::Vector3d::Zero());
}

}  // namespace

SafetyLimits safety_limits(const Settings& s) {
  return {s.force_limit_N, s.slew_limit_N_s,  s.energy_limit_J,
          s.power_limit_W, s.torque_limit_Nm, s.torque_slew_limit_Nm_s, s.workspace_m, 1 / s.rate_Hz};
}

void Safety::begin_tick(sync::HostTime now) {
  if (now - last_tick_ > Device::kWatchdog || last_tick_ - now > Device::kWatchdog) last_ = released_ = {};
  last_tick_ = now;
}

void Safety::release() {
  released_.force_N = clamped(last_.force_N + released_.force_N, limits_.force_N);
  released_.torque_N_m = clamped(last_.torque_N_m + released_.torque_N_m, limits_.torque_N_m);
  last_ = {};
  release_s_ = kRelease_s;
}

void Safety::set_position(const Eigen::Vector3d& device_m) {
  if (!device_m.allFinite()) {
    workspace_factor_ = 0;
    return;
  }
  if (!centre_m_) centre_m_ = device_m;
  const double remaining = 1 - (device_m - *centre_m_).norm() / limits_.workspace_m;
  workspace_factor_ = std::clamp(remaining / kWorkspaceEdge, 0.0, 1.0);
}

Safety::Acting Safety::acting(double dt) const {
  return acting_.value_or(
      Acting{{last_.force_N + released_.force_N, last_.torque_N_m + released_.torque_N_m}, dt});
}

Eigen::Vector3d Safety::limit(const Eigen::Vector3d& wanted_N, const Eigen::Vector3d& moved_m, double dt) {
  const Acting acted = acting(dt);
  acting_.reset();
  const bool jumped = !moved_m.allFinite() || moved_m.norm() > kMaxHandSpeed_m_s * acted.span_s;
  const double work_J = (jumped ? 0 : acted.wrench.force_N.dot(moved_m)) + std::exchange(torque_work_J_, 0.0);
  energy_J_ += work_J;
  // A negative tank recovers within a second, so that one bad instant does not stop touch for long.
  tank_J_ = std::clamp(tank_J_ - work_J + limits_.power_W * dt, -limits_.power_W, limits_.energy_J);
  const double left = release_s_ > dt ? 1 - dt / release_s_ : 0;
  release_s_ = std::max(0.0, release_s_ - dt);
  released_.force_N *= left;
  released_.torque_N_m *= left;
  const Eigen::Vector3d wanted = wanted_N.allFinite() ? wanted_N : Eigen::Vector3d(Eigen::Vector3d::Zero());
  // Beside the rest of another scene. The sum of two vectors is at most the sum of their magnitudes.
  const double limit_N = std::max(0.0, limits_.force_N - released_.force_N.norm());
  last_.force_N = risen(share_now() * clamped(wanted, limit_N), last_.force_N,
                        limits_.slew_N_s * std::min(dt, kMaxSlewTicks * limits_.period_s));
  return last_.force_N + released_.force_N;
}

// Factor of workspace and energy. Full force until half of the allowance is spent; the change is too slow to be felt as a
// step.
double Safety::share_now() const { return workspace_factor_ * std::clamp(2 * tank_J_ / limits_.energy_J, 0.0, 1.0); }

Wrench Safety::limit(const Wrench& wanted, const Eigen::Vector3d& moved_m, const Eigen::Vector3d& turned_rad,
                     double dt) {
  const Acting acted = acting(dt);
  const bool jumped = !turned_rad.allFinite() || turned_rad.norm() > kMaxHandSpin_rad_s * acted.span_s;
  torque_work_J_ = jumped ? 0 : acted.wrench.torque_N_m.dot(turned_rad);
  Wrench w = wanted;
  if (!w.torque_N_m.allFinite()) w.torque_N_m.setZero();
  if (!w.force_N.allFinite()) w = {};
  const double force = w.force_N.norm(), torque = w.torque_N_m.norm();
  if (force > limits_.force_N) w.torque_N_m *= limits_.force_N / force;
  if (torque > limits_.torque_N_m) w.force_N *= limits_.torque_N_m / torque;
  w.force_N = limit(w.force_N, moved_m, dt);
  const double limit_N_m = std::max(0.0, limits_.torque_N_m - released_.torque_N_m.norm());
  last_.torque_N_m = risen(share_now() * clamped(w.torque_N_m, limit_N_m), last_.torque_N_m,
                           limits_.torque_slew_N_m_s * std::min(dt, kMaxSlewTicks * limits_.period_s));
  w.torque_N_m = last_.torque_N_m + released_.torque_N_m;
  return w;
}

double Fade::step(sync::HostTime now, std::optional<sync::HostTime> newest, double dt) {
  const double age_s = newest ? sync::to_seconds(now - *newest) : stale_after_s_ + fade_s_;
  lost_ = std::abs(age_s) > stale_after_s_;
  const double ceiling =
      restarting_ || age_s < -stale_after_s_ ? 0 : std::clamp(1 - (age_s - stale_after_s_) / fade_s_, 0.0, 1.0);
  const double change = dt / fade_s_;
  value_ = std::clamp(ceiling, std::max(0.0, value_ - change), std::min(1.0, value_ + change));
  if (value_ <= 0) restarting_ = false;
  return value_;
}

}  // namespace tactus::haptic
