// Into which directions a mesh can be nearest to something: for each box of its tree a cone that holds the normals
// of its faces and of those around them (Johnson and Cohen 2001, Spatialized normal cone hierarchies).
#pragma once

#include <Eigen/Core>
#include <vector>

#include "sim_node/collision/layers/obb_tree.h"

namespace tactus::sim::gaps {

// Both ways along the axis: a surface may be met from behind. Open, where nothing is known: cosine 0, sine 1.
struct NormalCone {
  Eigen::Vector3f axis{0, 0, 1};
  float cosine = 0, sine = 1;
};

class NormalCones {
 public:
  explicit NormalCones(const ObbTree& tree);
  const NormalCone& of(int node, int lane) const {
    return cones_[static_cast<std::size_t>(node) * kLanes + static_cast<std::size_t>(lane)];
  }

  // Sine of the angle by which a way to what is nearest may lean from the triangle's own normal; 1 where nothing
  // is known.
  double lean(int triangle) const { return leans_[static_cast<std::size_t>(triangle)]; }

 private:
  std::vector<NormalCone> cones_;
  std::vector<double> leans_;
};

}  // namespace tactus::sim::gaps
