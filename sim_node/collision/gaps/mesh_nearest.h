// Contacts of two meshes in order of increasing gap. For callers that need only the nearest contact at each place
// and direction, such as a tool. This is much cheaper than finding all contacts.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "sim_node/collision/gaps/facing_pairs.h"
#include "sim_node/collision/gaps/feature_contacts.h"
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
    const features::FeatureTrees& features;
    const Eigen::Isometry3d& pose;
  };
  explicit MeshNearest(Isa isa) : facing_(isa), features_(isa) {}
  // Reports the pairs of the three layers that satisfy is_contact(), to within rounding, without those that are
  // over a face only by the edges of both meshes and are no local minimum of the distance. Pairs whose gaps are
  // equal to within a nanometre come in the order of their positions, which does not depend on the order of the
  // triangles. Searches in steps of the distance and stops with the visitor, so that the cost follows from the
  // nearest pairs, not from the reach. Calls is_contact() only for pairs that `visitor` does not report as
  // redundant. `scratch` is working memory. Deterministic. Real-time safe once the lists have grown.
  void find(const Mesh& a, const Mesh& b, double reach_m, PairVisitor& visitor, std::vector<PointPair>& scratch);

 private:
  struct Candidate {
    std::int64_t gap_nm;
    std::uint32_t pair;
    bool separated;
  };
  void find_near(const Mesh& a, const Mesh& b, const Eigen::Isometry3d& b_from_a, double tolerance_m,
                 std::vector<PointPair>& pairs);
  void list_candidates(const Mesh& a, const Mesh& b, double from_m, double to_m, std::vector<PointPair>& pairs);
  bool report(const Mesh& a, const Mesh& b, PairVisitor& visitor, const std::vector<PointPair>& pairs) const;

  FacingPairs facing_;
  FeatureContacts features_;
  Duplicates layer3_;
  std::vector<std::pair<int, int>> leaves_;
  std::vector<Candidate> candidates_;
  bool pierced_ = false;
};

// Whether pair x comes before y: by gap, in nanometres, then by position.
bool comes_first(const PointPair& x, const PointPair& y);

// Appends the result of complete_contact(), without types. A pair whose connection has a nearer point on one of
// the two triangles is not a contact; its gap is infinite. Appends nothing when the tilt of the connections
// (NormalCones) rules out a contact. Both triangles are in one frame.
void marked_pairs(const Triangle& a, double tilt_a, const Triangle& b, double tilt_b, double tolerance_m,
                  std::vector<PointPair>& out);

}  // namespace tactus::sim::gaps
