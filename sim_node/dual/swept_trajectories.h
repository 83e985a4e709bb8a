// Trajectories of all bodies that are simulated ahead, for one visual step, and the pairs that touch in it. The
// visual group prepares them for grouping, so that the cost of a haptic tick depends only on the haptic group. Pure.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "sim_node/model/bounds_grid.h"
#include "sim_node/model/state_archive.h"

namespace tactus::sim {

class SweptTrajectories {
 public:
  // bodies: number of bodies of the world. members: ascending body numbers; trajectories: one per member, from the
  // beginning of the step on. touching: pairs of bodies. Realtime-safe once the lists have grown.
  void set(std::size_t bodies, std::span<const int> members, std::span<const SweptSphere> trajectories,
           std::span<const std::pair<int, int>> touching, double horizon_s);

  bool has(int body) const { return at_[index(body)] >= 0; }
  // Trajectory of a member, from the beginning of the step on.
  const SweptSphere& of(int body) const { return trajectories_[index(at_[index(body)])]; }
  // Appends the members whose trajectories may meet these bounds to `found`, in ascending order.
  void find(const Bounds& query, std::vector<int>& found) const;
  // bodies: number of bodies of the world.
  void archive(StateArchive& a, std::size_t bodies);
  // The bodies that a body touches in the step.
  std::span<const int> touched_by(int body) const;

 private:
  static std::size_t index(int i) { return static_cast<std::size_t>(i); }
  std::vector<int> members_, at_;
  std::vector<SweptSphere> trajectories_;
  std::vector<Bounds> boxes_;
  BoundsGrid grid_;
  std::vector<int> first_, touched_, next_;
  double horizon_s_ = 0;
};

}  // namespace tactus::sim
