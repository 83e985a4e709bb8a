// Spatialized normal cones: for each box of a mesh's tree, a cone that contains the normals of its faces and of their
// neighbours (Johnson and Cohen 2001, Spatialized normal cone hierarchies). They limit the directions in which the
// mesh can be nearest to another surface.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "sim_node/collision/layers/obb_tree.h"

namespace tactus::sim::gaps {

// Double-sided, since a surface may be approached from behind. An open cone has cosine 0 and sine 1.
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

  // Sine of the largest angle between the triangle's normal and a connection to the nearest point; 1 where it is
  // unknown.
  double tilt_sine(int triangle) const { return tilts_[static_cast<std::size_t>(triangle)]; }

 private:
  std::vector<NormalCone> cones_;
  std::vector<double> tilts_;
};

}  // namespace tactus::sim::gaps
