// What may be set of a world in two groups.
#include <algorithm>

#include "sim_node/dual/dual_groups.h"

namespace tactus::sim {
namespace {

// Between two visual steps; design: a flood of commands is held back long before (sim_node: 4 a tick).
constexpr std::size_t kMaxWaiting = 256;

}  // namespace

// The haptic group follows at once, the visual group from the next step that is computed on.
bool DualGroups::apply(const impulse::SceneChange& change) {
  if (changes_.size() >= kMaxWaiting || !scene_.apply(*world_, change)) return false;
  changes_.push_back(change);
  stale_ = true;
  return true;
}

bool DualGroups::wish(const Wish& w) {
  if (world_->unit_of(w.body) < 0 || wishes_.size() >= kMaxWaiting) return false;
  if (!is_haptic(w.body)) grouping_.want(w.body);
  wishes_.push_back(w);
  return true;
}

bool DualGroups::set_pose(int body, const Eigen::Isometry3d& pose) {
  if (!world_->is_free(body)) return false;
  return wish({Wish::kPose, body, pose.translation(), Eigen::Quaterniond(pose.linear()).normalized()});
}

bool DualGroups::set_velocity(int body, const Eigen::Vector3d& velocity_m_s) {
  return wish({Wish::kVelocity, body, velocity_m_s, Eigen::Quaterniond::Identity()});
}

bool DualGroups::set_spin(int body, const Eigen::Vector3d& spin_rad_s) {
  return wish({Wish::kSpin, body, spin_rad_s, Eigen::Quaterniond::Identity()});
}

void DualGroups::grant_wishes() {
  if (wishes_.empty()) return;
  for (const Wish& w : wishes_) {
    if (!is_haptic(w.body)) continue;
    if (w.kind == Wish::kPose) scene_.set_pose(*world_, w.body, Eigen::Translation3d(w.vector) * w.turn);
    if (w.kind == Wish::kVelocity) world_->set_velocity(w.body, w.vector);
    if (w.kind == Wish::kSpin) world_->set_spin(w.body, w.vector);
  }
  std::erase_if(wishes_, [this](const Wish& w) { return is_haptic(w.body); });
  read_motions(world_->active_bodies());
  stale_ = true;
}

}  // namespace tactus::sim
