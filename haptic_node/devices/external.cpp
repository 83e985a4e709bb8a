#include "haptic_node/devices/external.h"

#include <algorithm>
#include <tactus/device_force_t.hpp>
#include <tactus/device_state_t.hpp>

#include "lcmtypes/vectors.h"

namespace tactus::haptic {

External::External(std::string name, const Eigen::Vector3d& offset_m, double stale_after_s)
    : name_(std::move(name)), offset_m_(offset_m), stale_after_(sync::from_seconds(stale_after_s)) {
  believed_.position = offset_m_;
  force_.header.sim_time_ns = -1;
  force_.device = name_;
  force_.valid_for_ns = kWatchdog.count();
}

void External::hear(const device_state_t& state, sync::HostTime arrival) {
  if (state.device != name_) return;
  const bool silent = !newest_ || arrival - heard_ > stale_after_;
  if (newest_ && state.header.incarnation != newest_->header.incarnation) {
    if (!silent) {
      contradicted_ = arrival;
      return;
    }
  } else if (newest_) {
    // A repetition, or overtaken by a newer one.
    const std::int64_t passed_ns = state.header.publish_time_ns - newest_->header.publish_time_ns;
    if (passed_ns <= 0) return;
    // Messages that queued up arrive together, so this uses the times of the sender; at least one tick, because
    // its clock may be coarse.
    const double passed_s = std::max(1e-9 * static_cast<double>(passed_ns), 1e-3);
    const double leap_m = (to_eigen(state.pose.position_m) - to_eigen(newest_->pose.position_m)).norm();
    if (!silent && leap_m > kFastest_m_s * passed_s) contradicted_ = arrival;
  }
  newest_ = state;
  heard_ = arrival;
}

void External::hear(const device_force_t& others, sync::HostTime arrival) {
  if (others.device == name_) contradicted_ = arrival;
}

bool External::lost(sync::HostTime now) const {
  return !newest_ || newest_->state != device_state_t::ANSWERS || now - heard_ > stale_after_ ||
         (contradicted_ && now - *contradicted_ < stale_after_);
}

DeviceState External::read(sync::HostTime now) {
  believed_.lost = lost(now);
  if (believed_.lost) {
    believed_.velocity.setZero();
    believed_.spin.setZero();
    believed_.buttons = 0;
    return believed_;
  }
  believed_.position = offset_m_ + to_eigen(newest_->pose.position_m);
  believed_.orientation = to_eigen(newest_->pose.orientation).normalized();
  believed_.velocity = to_eigen(newest_->velocity_m_s);
  believed_.spin = to_eigen(newest_->spin_rad_s);
  believed_.buttons = newest_->buttons;
  return believed_;
}

void External::write(const Wrench& wrench) {
  force_.force_N = to_vec3f(wrench.force_N);
  force_.torque_N_m = to_vec3f(wrench.torque_N_m);
}

}  // namespace tactus::haptic
