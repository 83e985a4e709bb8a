#include "haptic_node/rendering/force_crossfade.h"

#include <algorithm>

namespace tactus::haptic {

// True when the binding surfaces differ from those of the last tick; stores the current ones.
bool ForceCrossfade::binding_set_changed(std::span<const Surface> surfaces) {
  std::size_t bound = 0;
  bool same = true;
  for (const Surface& s : surfaces) {
    if (s.depth_m <= 0) continue;
    same = same && std::find(last_set_.begin(), last_set_.end(), s.contact_id) != last_set_.end();
    ++bound;
  }
  same = same && bound == last_set_.size();
  last_set_.clear();
  for (const Surface& s : surfaces)
    if (s.depth_m > 0 && last_set_.size() < kMaxHalfSpaces) last_set_.push_back(s.contact_id);
  return !same;
}

void ForceCrossfade::reset() {
  last_set_.clear();
  last_.setZero();
  remainder_.setZero();
  remaining_s_ = 0;
}

Eigen::Vector3d ForceCrossfade::step(std::span<const Surface> surfaces, const Eigen::Vector3d& force_N, double dt) {
  const bool was_pressed = !last_set_.empty() && !last_.isZero(0);
  const bool changed = binding_set_changed(surfaces) || restart_pending_;
  restart_pending_ = false;
  if (last_set_.empty() || !was_pressed || force_N.isZero(0)) {
    remainder_.setZero();
  } else {
    const double fraction = remaining_s_ > dt ? dt / remaining_s_ : 1;
    remainder_ -= fraction * remainder_;
    remaining_s_ = std::max(0.0, remaining_s_ - dt);
    if (changed) {
      const Eigen::Vector3d jump = force_N + remainder_ - last_;
      const double size = jump.norm(), at_once = step_N_s_ * dt;
      if (size > at_once) {
        remainder_ -= jump * (1 - at_once / size);
        remaining_s_ = time_s_;
      }
    }
  }
  last_ = force_N + remainder_;
  return last_;
}

}  // namespace tactus::haptic
