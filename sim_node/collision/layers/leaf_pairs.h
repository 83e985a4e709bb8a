// Layer 1 of I-Touch: pairs of triangles of two meshes that may be within the tolerance.
#pragma once

#include <Eigen/Geometry>
#include <utility>
#include <vector>

#include "sim_node/collision/layers/isa.h"
#include "sim_node/collision/layers/obb_tree.h"

namespace tactus::sim {

class LeafPairs {
 public:
  explicit LeafPairs(Isa isa = best_isa());
  // Writes (triangle of a, triangle of b) into `out`, after clearing it: all pairs within the tolerance and some
  // others, since every box is enlarged by half the tolerance along its own axes. The order depends only on the trees
  // and poses. Real-time safe once the lists have grown.
  void find(const ObbTree& a, const Eigen::Isometry3d& pose_a, const ObbTree& b, const Eigen::Isometry3d& pose_b,
            double tolerance_m, std::vector<std::pair<int, int>>& out);

 private:
  struct Slot {
    int node, lane;
  };
  struct Step {
    Slot a, b;
  };
  OverlapTest overlap_;
  std::vector<Step> open_;
};

}  // namespace tactus::sim
