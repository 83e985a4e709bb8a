// Layer 1 of I-Touch: which triangles of two meshes may be within the tolerance of each other.
#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <utility>
#include <vector>

#include "sim_node/collision/layers/isa.h"
#include "sim_node/collision/layers/obb_tree.h"

namespace tactus::sim {

class LeafPairs {
 public:
  explicit LeafPairs(Isa isa = best_isa());
  // (triangle of a, triangle of b) into `out`, cleared first: all that are within the tolerance and some that are
  // not, since every box is enlarged by half the tolerance along its own axes. The order depends on the trees and
  // poses alone. Realtime-safe once the lists have grown.
  void find(const ObbTree& a, const Eigen::Isometry3d& pose_a, const ObbTree& b, const Eigen::Isometry3d& pose_b,
            double tolerance_m, std::vector<std::pair<int, int>>& out);
  // The same for a tolerance that shrinks: near triangles come first, and `leaf` gets each pair that may still be
  // within and returns the tolerance from then on.
  using Leaf = std::function<double(int, int)>;
  void narrow(const ObbTree& a, const Eigen::Isometry3d& pose_a, const ObbTree& b, const Eigen::Isometry3d& pose_b,
              double tolerance_m, const Leaf& leaf);
  // Box tests of the last search, eight boxes each.
  long long tests() const { return tests_; }

 private:
  struct Slot {
    int node, lane;
  };
  struct Step {
    Slot a, b;
  };
  template <bool kNearFirst, class Found>
  void descend(const ObbTree& a, const Eigen::Isometry3d& pose_a, const ObbTree& b,
               const Eigen::Isometry3d& pose_b, double tolerance_m, Found&& found);
  OverlapTest overlap_;
  std::vector<Step> open_;
  long long tests_ = 0;
};

}  // namespace tactus::sim
