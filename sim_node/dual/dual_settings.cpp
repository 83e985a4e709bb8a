// Changes that can be applied to a running world in two groups.

#include "sim_node/dual/dual_groups.h"

namespace tactus::sim {
namespace {

// Maximum number of changes between two visual steps; design: the limit of the command queue (sim_node: 4 per tick)
// is reached long before.
constexpr std::size_t kMaxQueued = 256;

}  // namespace

// The haptic group applies the change immediately, the visual group from the next step that it computes.
bool DualGroups::apply(const impulse::SceneChange& change) {
  if (changes_.size() >= kMaxQueued || !scene_.apply(*world_, change)) return false;
  changes_.push_back(change);
  stale_ = true;
  return true;
}

bool DualGroups::queue_change(const QueuedChange& w) {
  if (world_->unit_of(w.body) < 0 || queued_changes_.size() >= kMaxQueued) return false;
  if (!is_haptic(w.body)) grouping_.request_entry(w.body);
  queued_changes_.push_back(w);
  return true;
}

bool DualGroups::set_pose(int body, const Eigen::Isometry3d& pose) {
  if (!world_->is_free(body)) return false;
  return queue_change({QueuedChange::kPose, body, pose.translation(), Eigen::Quaterniond(pose.linear()).normalized()});
}

bool DualGroups::set_velocity(int body, const Eigen::Vector3d& velocity_m_s) {
  return queue_change({QueuedChange::kVelocity, body, velocity_m_s, Eigen::Quaterniond::Identity()});
}

bool DualGroups::set_spin(int body, const Eigen::Vector3d& spin_rad_s) {
  return queue_change({QueuedChange::kSpin, body, spin_rad_s, Eigen::Quaterniond::Identity()});
}

void DualGroups::apply_queued_changes() {
  if (queued_changes_.empty()) return;
  for (const QueuedChange& w : queued_changes_) {
    if (!is_haptic(w.body)) continue;
    if (w.kind == QueuedChange::kPose) scene_.set_pose(*world_, w.body, Eigen::Translation3d(w.vector) * w.orientation);
    if (w.kind == QueuedChange::kVelocity) world_->set_velocity(w.body, w.vector);
    if (w.kind == QueuedChange::kSpin) world_->set_spin(w.body, w.vector);
  }
  std::erase_if(queued_changes_, [this](const QueuedChange& w) { return is_haptic(w.body); });
  read_motions(world_->active_bodies());
  stale_ = true;
}

}  // namespace tactus::sim
