#include "sim_node/dual/sleeping_islands.h"

#include <algorithm>

#include "sim_node/model/index.h"

namespace tactus::sim {
namespace {

int root(std::vector<int>& parent, int i) {
  while (parent[index(i)] != i) i = parent[index(i)] = parent[index(parent[index(i)])];
  return i;
}

// A body that comes nearer than this wakes a resting body, m; design: ten times the jitter of a resting contact.
constexpr double kNear_m = 0.001;

}  // namespace

SleepingIslands::SleepingIslands(std::vector<char> may_sleep)
    : may_sleep_(std::move(may_sleep)),
      slow_for_(may_sleep_.size()),
      island_(may_sleep_.size(), -1),
      parent_(may_sleep_.size()),
      slow_(may_sleep_.size()) {}

std::span<const int> SleepingIslands::update(std::span<const int> bodies, std::span<const BodyMotion> motions,
                                             std::span<const std::pair<int, int>> touching,
                                             std::span<const char> supported, sync::Nanoseconds length) {
  changed_.clear();
  for (const int i : bodies) {
    const BodyMotion& m = motions[index(i)];
    const bool still =
        m.velocity_m_s.norm() < kSleepSpeed_m_s && m.spin_rad_s.norm() < kSleepSpin_rad_s && supported[index(i)];
    slow_for_[index(i)] = still ? std::min(slow_for_[index(i)] + length, kTimeToSleep) : sync::Nanoseconds(0);
    parent_[index(i)] = i;
    slow_[index(i)] = 1;  // indexed by the smallest body of an island
  }
  const auto moves = [&](int i) { return motions[index(i)].moves() && !is_asleep(i); };
  for (const auto& [a, b] : touching) {
    if (!moves(a) || !moves(b)) continue;
    const int x = root(parent_, a), y = root(parent_, b);
    parent_[index(std::max(x, y))] = std::min(x, y);
  }
  for (const int i : bodies)
    if (!(may_sleep_[index(i)] && slow_for_[index(i)] >= kTimeToSleep)) slow_[index(root(parent_, i))] = 0;
  for (const int i : bodies)
    if (slow_[index(root(parent_, i))]) changed_.push_back(i);
  for (const int i : changed_) island_[index(i)] = root(parent_, i);
  if (!changed_.empty()) {
    sleeping_.insert(sleeping_.end(), changed_.begin(), changed_.end());
    std::sort(sleeping_.begin(), sleeping_.end());
    stale_ = true;
  }
  return changed_;
}

void SleepingIslands::rebuild(std::span<const BodyMotion> motions, std::span<const double> radii_m) {
  boxes_.clear();
  for (const int i : sleeping_)
    boxes_.push_back(
        bounds_of({motions[index(i)].centre_m, Eigen::Vector3d::Zero(), radii_m[index(i)], kNear_m}, 0));
  grid_.build(boxes_);
  stale_ = false;
}

// Wakes the islands in woken_.
std::span<const int> SleepingIslands::wake_islands() {
  changed_.clear();
  if (woken_.empty()) return changed_;
  std::sort(woken_.begin(), woken_.end());
  const auto wakes = [&](int i) { return std::binary_search(woken_.begin(), woken_.end(), island_[index(i)]); };
  std::copy_if(sleeping_.begin(), sleeping_.end(), std::back_inserter(changed_), wakes);
  std::erase_if(sleeping_, wakes);
  for (const int i : changed_) {
    island_[index(i)] = -1;
    slow_for_[index(i)] = sync::Nanoseconds(0);
  }
  stale_ = true;
  return changed_;
}

std::span<const int> SleepingIslands::near(std::span<const SweptSphere> trajectories,
                                           std::span<const BodyMotion> motions, std::span<const double> radii_m,
                                           double horizon_s) {
  near_.clear();
  if (sleeping_.empty()) return near_;
  if (stale_) rebuild(motions, radii_m);
  for (const SweptSphere& trajectory : trajectories) {
    found_.clear();
    grid_.find(bounds_of(trajectory, horizon_s), found_);
    for (const int k : found_) near_.push_back(sleeping_[index(k)]);
  }
  std::sort(near_.begin(), near_.end());
  near_.erase(std::unique(near_.begin(), near_.end()), near_.end());
  return near_;
}

std::span<const int> SleepingIslands::wake_islands_of(std::span<const int> bodies) {
  woken_.clear();
  for (const int i : bodies)
    if (is_asleep(i)) woken_.push_back(island_[index(i)]);
  return wake_islands();
}

std::span<const int> SleepingIslands::wake_all() {
  woken_.clear();
  for (const int i : sleeping_) woken_.push_back(island_[index(i)]);
  return wake_islands();
}

void SleepingIslands::archive(StateArchive& a) {
  a.fixed(slow_for_, [&](sync::Nanoseconds& t) {
    std::int64_t ns = t.count();
    a(ns);
    a.require(ns >= 0 && ns <= kTimeToSleep.count(), "the state holds a number out of range");
    t = sync::Nanoseconds(ns);
  });
  a.fixed(island_, [&](int& i) { a.index(i, island_.size()); });
  if (!a.reads()) return;
  sleeping_.clear();
  for (std::size_t i = 0; i < island_.size(); ++i)
    if (island_[i] >= 0) sleeping_.push_back(static_cast<int>(i));
  stale_ = true;
}

}  // namespace tactus::sim
