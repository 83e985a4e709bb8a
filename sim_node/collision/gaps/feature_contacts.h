// Point pairs of two meshes that may be contacts, feature by feature: every vertex over a face, and every local
// minimum of the distance between vertices and edges. A pair of features is found once, not once for each pair of
// their triangles.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "sim_node/collision/features/feature_search.h"
#include "sim_node/model/point_pair.h"

namespace tactus::sim::gaps {

class FeatureContacts {
 public:
  explicit FeatureContacts(Isa isa) : search_(isa) {}
  // Appends the pairs with a gap above above_m (at least features::kNear_m) and up to reach_m, in the frame of b,
  // with one triangle of each feature. Some of them are no contacts, by is_contact(). Pairs that are not appended
  // are no vertex over a face without a much nearer edge at that vertex, and no local minimum of the distance on
  // both meshes. Deterministic. Real-time safe once the lists have grown.
  void find(const features::FeatureTrees& a, const features::FeatureTrees& b, const Eigen::Isometry3d& b_from_a,
            double above_m, double reach_m, std::vector<PointPair>& out);

 private:
  features::FeatureSearch search_;
  std::vector<features::FeaturePair> found_;
};

// The triangle in the frame of b, with the directions of its edges.
Triangle in_frame_of_b(const Triangle& t, const Eigen::Isometry3d& b_from_a);

}  // namespace tactus::sim::gaps
