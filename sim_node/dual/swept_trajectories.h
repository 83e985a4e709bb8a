// The ways of all bodies that are simulated ahead, for one visual step, and who touches whom in it: what grouping
// asks about, made ready where the step is computed, so that a haptic tick costs what its group costs. Pure.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "sim_node/model/bounds_grid.h"
#include "sim_node/model/state_archive.h"

namespace tactus::sim {

class SweptTrajectories {
 public:
  // members: ascending numbers of bodies of the world, which has so many; ways: of each, from the beginning of the
  // step on. touching: pairs of bodies. Realtime-safe once its lists have grown.
  void set(std::size_t bodies, std::span<const int> members, std::span<const SweptSphere> ways,
           std::span<const std::pair<int, int>> touching, double horizon_s);

  bool has(int body) const { return at_[index(body)] >= 0; }
  // Of a member, from the beginning of the step on.
  const SweptSphere& of(int body) const { return ways_[index(at_[index(body)])]; }
  // Members whose ways may meet these bounds, into `found`, appended in ascending order.
  void find(const Bounds& query, std::vector<int>& found) const;
  // bodies: how many the world has.
  void archive(StateArchive& a, std::size_t bodies);
  // What a body touches in the step.
  std::span<const int> beside(int body) const;

 private:
  static std::size_t index(int i) { return static_cast<std::size_t>(i); }
  std::vector<int> members_, at_;
  std::vector<SweptSphere> ways_;
  std::vector<Bounds> boxes_;
  BoundsGrid grid_;
  std::vector<int> first_, beside_, next_;
  double horizon_s_ = 0;
};

}  // namespace tactus::sim
