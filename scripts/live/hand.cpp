#include "scripts/live/hand.h"

#include <algorithm>
#include <cmath>

#include "lcmtypes/vectors.h"

namespace tactus::live {

Eigen::Vector3d unproject(const scene_t& scene, double aspect, double x, double y, double depth_m) {
  // The camera looks along +x with z up; its field of view is the horizontal one.
  const double half = std::tan(scene.camera_fov_rad / 2);
  return to_eigen(scene.camera) * Eigen::Vector3d(depth_m, -x * half * depth_m, y * half / aspect * depth_m);
}

void Hand::aim(const HandTarget& at, const scene_t& scene, double aspect, const std::optional<Eigen::Vector3d>& tool,
               sync::HostTime now) {
  const bool grabbed = !last_input_ || now - *last_input_ > kTimeout;
  if (grabbed) {
    const double depth_m = tool ? (to_eigen(scene.camera).inverse() * *tool).x() : 0.5;
    depth_m_ = std::isfinite(depth_m) && depth_m > kMinDepth_m ? depth_m : 0.5;
    last_step_.reset();
  }
  depth_m_ = std::clamp(depth_m_ + at.push_m, kMinDepth_m, kMaxDepth_m);
  target_m_ = unproject(scene, aspect, at.x, at.y, depth_m_);
  if (grabbed) at_m_ = tool && tool->allFinite() ? *tool : target_m_;
  down_ = at.down;
  last_input_ = now;
}

std::optional<device_state_t> Hand::state(sync::HostTime now) {
  if (!last_input_ || now - *last_input_ > kTimeout) return std::nullopt;
  const double dt_s = last_step_ ? std::clamp(sync::to_seconds(now - *last_step_), 0.0, 0.1) : 0;
  last_step_ = now;
  Eigen::Vector3d step_m = target_m_ - at_m_;
  const double max_step_m = kMaxSpeed_m_s * dt_s;
  if (step_m.norm() > max_step_m) step_m *= max_step_m / step_m.norm();
  at_m_ += step_m;
  device_state_t m{};
  m.header.sim_time_ns = -1;
  m.device = kHandDevice;
  m.pose.position_m = {at_m_.x(), at_m_.y(), at_m_.z()};
  m.pose.orientation.w = 1;
  if (dt_s > 0) {
    const Eigen::Vector3f v = (step_m / dt_s).cast<float>();
    m.velocity_m_s = {v.x(), v.y(), v.z()};
  }
  m.buttons = down_ ? 1 : 0;
  m.state = device_state_t::ANSWERS;
  return m;
}

}  // namespace tactus::live
