// Tree of boxes over the faces, edges or vertices of a mesh, eight per node, with the directions in which another
// surface can be nearest to them: spatialized normal cones (Johnson and Cohen 2001), per feature instead of per
// triangle.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "sim_node/collision/features/feature_node.h"
#include "sim_node/collision/features/mesh_features.h"

namespace tactus::sim::features {

// Immutable after construction: any number of threads may query one tree.
class FeatureTree {
 public:
  FeatureTree() = default;
  // boxes: one triangle per feature, which may be a segment or a point. features, cones: number and directions of
  // each.
  FeatureTree(const ObbTree& boxes, const std::vector<int>& features, const std::vector<DirectionCone>& cones);

  // The first node holds one box around all features. Centres are relative to origin().
  const std::vector<FeatureNode>& nodes() const { return nodes_; }
  const Eigen::Vector3d& origin() const { return origin_; }
  double radius_m() const { return radius_m_; }
  bool empty() const { return nodes_.empty(); }

 private:
  void set_directions(std::size_t node, int lane, const std::vector<int>& below,
                      const std::vector<DirectionCone>& cones);
  std::vector<int> gather(const ObbTree& boxes, std::size_t node, const std::vector<int>& features,
                          const std::vector<DirectionCone>& cones);

  std::vector<FeatureNode> nodes_;
  Eigen::Vector3d origin_{0, 0, 0};
  double radius_m_ = 0;
};

// The trees of a mesh that are searched for the contacts nearest to each other.
struct FeatureTrees {
  explicit FeatureTrees(const ObbTree& mesh);
  MeshFeatures mesh;
  FeatureTree faces;  // directions: along the normal
  FeatureTree edges;
  FeatureTree vertices;               // of all vertices, in all directions
  FeatureTree peaks;                  // of the vertices that can be nearest in some direction
  std::vector<EdgeLanes> edge_lanes;  // by node of `edges`
};

}  // namespace tactus::sim::features
