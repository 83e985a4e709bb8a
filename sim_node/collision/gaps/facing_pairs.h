// Pairs of triangles of two meshes that may hold a contact: within reach of each other, and with a connection that
// leaves one of them within its cone of normals.
#pragma once

#include <Eigen/Geometry>
#include <utility>
#include <vector>

#include "sim_node/collision/gaps/normal_cones.h"
#include "sim_node/collision/layers/isa.h"

namespace tactus::sim::gaps {

class FacingPairs {
 public:
  struct Mesh {
    const ObbTree& tree;
    const NormalCones& cones;
    const Eigen::Isometry3d& pose;
  };
  explicit FacingPairs(Isa isa);
  // Writes (triangle of a, triangle of b) into `out`, after clearing it. Deterministic. Real-time safe once the lists
  // have grown.
  void find(const Mesh& a, const Mesh& b, double reach_m, std::vector<std::pair<int, int>>& out);

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

}  // namespace tactus::sim::gaps
