#include "haptic_node/devices/spidar/window_velocity.h"

#include <algorithm>
#include <cmath>

namespace tactus::haptic {

Eigen::Vector3d WindowVelocity::add(const Eigen::Vector3d& position_m, sync::HostTime at) {
  if (count_ > 0 && at <= back(0).at) clear();
  newest_ = (newest_ + 1) % kMax;
  samples_[newest_] = {position_m, at};
  count_ = std::min(count_ + 1, kMax);

  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
  for (int axis = 0; axis < 3; ++axis) {
    for (std::size_t length = 1; length < count_; ++length) {
      const double over_s = sync::to_seconds(at - back(length).at);
      const double slope = (position_m(axis) - back(length).position_m(axis)) / over_s;
      bool fits = true;
      for (std::size_t i = 1; i < length && fits; ++i) {
        const double line = position_m(axis) - slope * sync::to_seconds(at - back(i).at);
        fits = std::abs(back(i).position_m(axis) - line) <= step_m_;
      }
      if (!fits) break;
      velocity(axis) = slope;
    }
  }
  return velocity;
}

}  // namespace tactus::haptic
