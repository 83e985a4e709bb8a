// Contacts of two meshes in order of increasing gap. For callers that need only the nearest contact at each place
// and direction, such as a tool. This is much cheaper than finding all contacts.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "sim_node/collision/gaps/facing_pairs.h"
#include "sim_node/collision/layers/mesh_contact.h"
#include "sim_node/collision/nearest_first.h"
#include "sim_node/collision/triangle_tree.h"

namespace tactus::sim::gaps {

class MeshNearest {
 public:
  struct Mesh {
    const TriangleTree& tree;
    const ContactMesh& layers;
    const NormalCones& cones;
    const Eigen::Isometry3d& pose;
  };
  explicit MeshNearest(Isa isa) : facing_(isa) {}
  // Reports the pairs of the three layers that satisfy is_contact(), to within rounding. Calls is_contact() only
  // for pairs that `visitor` does not report as redundant. `scratch` is working memory. Deterministic. Real-time
  // safe once the lists have grown.
  void find(const Mesh& a, const Mesh& b, double reach_m, PairVisitor& visitor, std::vector<PointPair>& scratch);

 private:
  FacingPairs facing_;
  Duplicates layer3_;
  std::vector<std::pair<int, int>> leaves_;
  struct Candidate {
    double gap_m;
    std::uint32_t pair;
    bool separated;
  };
  std::vector<Candidate> candidates_;
};

// Appends the result of complete_contact(), without types. A pair whose connection has a nearer point on one of
// the two triangles is not a contact; its gap is infinite. Appends nothing when the tilt of the connections
// (NormalCones) rules out a contact. Both triangles are in one frame.
void marked_pairs(const Triangle& a, double tilt_a, const Triangle& b, double tilt_b, double tolerance_m,
                  std::vector<PointPair>& out);

}  // namespace tactus::sim::gaps
