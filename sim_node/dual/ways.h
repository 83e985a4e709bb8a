// The ways of all bodies that are simulated ahead, for one visual step, and who touches whom in it: what grouping
// asks about, made ready where the step is computed, so that a haptic tick costs what its group costs. Pure.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "sim_node/behaviour/body_motion.h"
#include "sim_node/dual/bounds_grid.h"

namespace tactus::sim {

class Ways {
 public:
  // members: ascending numbers of the bodies whose ways these are. motions: of every body, at the beginning of the
  // step; velocities those of the straight ways. radii_m: of every body. strays_m: of each member, how far it will
  // be at most from its straight way. touching: pairs of bodies. Realtime-safe once its lists have grown.
  void set(std::span<const int> members, std::span<const BodyMotion> motions, std::span<const double> radii_m,
           std::span<const double> strays_m, std::span<const std::pair<int, int>> touching, double horizon_s);

  bool has(int body) const { return at_[index(body)] >= 0; }
  // Of a member, from the beginning of the step on.
  const SweptSphere& of(int body) const { return ways_[index(at_[index(body)])]; }
  // Members whose ways may meet these bounds, into `found`, appended in ascending order.
  void find(const Bounds& query, std::vector<int>& found) const;
  // What a body touches in the step.
  std::span<const int> beside(int body) const;

 private:
  static std::size_t index(int i) { return static_cast<std::size_t>(i); }
  std::vector<int> members_, at_;
  std::vector<SweptSphere> ways_;
  std::vector<Bounds> boxes_;
  BoundsGrid grid_;
  std::vector<int> first_, beside_, next_;
};

}  // namespace tactus::sim
