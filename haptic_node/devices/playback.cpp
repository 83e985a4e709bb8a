#include "haptic_node/devices/playback.h"

#include "haptic_node/contact/rotation_math.h"

namespace tactus::haptic {

Playback::Playback(Motion motion, const Placement& placement)
    : curve_(std::move(motion.times_s), std::move(motion.positions_m), MonotoneCubic::Ends::kMoving),
      orientations_(std::move(motion.orientations)),
      placement_(placement) {}

DeviceState Playback::read(sync::HostTime now) {
  const double t = curve_.begin_s() + (begin_ ? sync::to_seconds(now - *begin_) * placement_.rate : 0);
  const auto at = curve_.at(t);
  const auto [i, s] = curve_.locate(t);
  DeviceState state;
  state.position = placement_.scale * at.position + placement_.offset_m;
  state.velocity = placement_.scale * placement_.rate * at.velocity;
  state.orientation =
      i + 1 < orientations_.size() ? orientations_[i].slerp(s, orientations_[i + 1]) : orientations_[i];
  if (last_ && now > last_->first)
    spin_ = rotation_between(last_->second, state.orientation) / sync::to_seconds(now - last_->first);
  if (!last_ || now > last_->first) last_.emplace(now, state.orientation);
  state.spin = spin_;
  return state;
}

}  // namespace tactus::haptic
