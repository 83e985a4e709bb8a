#include "haptic_node/devices/external.h"

#include <algorithm>
#include <tactus/device_force_t.hpp>
#include <tactus/device_state_t.hpp>

#include "lcmtypes/vectors.h"

namespace tactus::haptic {

External::External(std::string name, const Eigen::Vector3d& offset_m, double stale_after_s)
    : name_(std::move(name)), offset_m_(offset_m), stale_after_(sync::from_seconds(stale_after_s)) {
  accepted_.position = offset_m_;
  force_.header.sim_time_ns = -1;
  force_.device = name_;
  force_.valid_for_ns = kWatchdog.count();
}

void External::on_message(const device_state_t& state, sync::HostTime arrival) {
  if (state.device != name_) return;
  const bool silent = !newest_ || arrival - newest_arrival_ > stale_after_;
  if (newest_ && state.header.incarnation != newest_->header.incarnation) {
    if (!silent) {
      last_contradiction_ = arrival;
      return;
    }
  } else if (newest_) {
    // The message is a repetition, or a newer one has overtaken it.
    const std::int64_t passed_ns = state.header.publish_time_ns - newest_->header.publish_time_ns;
    if (passed_ns <= 0) return;
    // Messages that queued up arrive together, so this uses the times of the sender; at least one tick, because
    // its clock may be coarse.
    const double passed_s = std::max(1e-9 * static_cast<double>(passed_ns), 1e-3);
    const double jump_m = (to_eigen(state.pose.position_m) - to_eigen(newest_->pose.position_m)).norm();
    if (!silent && jump_m > kMaxSpeed_m_s * passed_s) last_contradiction_ = arrival;
  }
  newest_ = state;
  newest_arrival_ = arrival;
}

void External::on_message(const device_force_t& others, sync::HostTime arrival) {
  if (others.device == name_) last_contradiction_ = arrival;
}

bool External::lost(sync::HostTime now) const {
  return !newest_ || newest_->state != device_state_t::ANSWERS || now - newest_arrival_ > stale_after_ ||
         (last_contradiction_ && now - *last_contradiction_ < stale_after_);
}

DeviceState External::read(sync::HostTime now) {
  accepted_.lost = lost(now);
  if (accepted_.lost) {
    accepted_.velocity.setZero();
    accepted_.spin.setZero();
    accepted_.buttons = 0;
    return accepted_;
  }
  accepted_.position = offset_m_ + to_eigen(newest_->pose.position_m);
  accepted_.orientation = to_eigen(newest_->pose.orientation).normalized();
  accepted_.velocity = to_eigen(newest_->velocity_m_s);
  accepted_.spin = to_eigen(newest_->spin_rad_s);
  accepted_.buttons = newest_->buttons;
  return accepted_;
}

void External::write(const Wrench& wrench) {
  force_.force_N = to_vec3f(wrench.force_N);
  force_.torque_N_m = to_vec3f(wrench.torque_N_m);
}

}  // namespace tactus::haptic
