// Pairs of features of two meshes that may be nearest to each other within a reach.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "sim_node/collision/features/feature_tree.h"
#include "sim_node/collision/layers/isa.h"

namespace tactus::sim::features {

struct FeaturePair {
  int from, to;
};

// Descends one tree; each of its parts takes over the list of the parts of the other tree that its parent may
// meet.
class FeatureSearch {
 public:
  explicit FeatureSearch(Isa isa);
  // Writes (feature of `from`, feature of `to`) into `out`, after clearing it: all pairs within reach in
  // directions that both allow, and some others. to_from: maps the frame of `from` to that of `to`. Deterministic.
  // Real-time safe once the lists have grown.
  void find(const FeatureTree& from, const FeatureTree& to, const Eigen::Isometry3d& to_from, double reach_m,
            std::vector<FeaturePair>& out);
  // The same for edges. Leaves out pairs whose lines are not nearest to each other between their ends on the outer
  // sides of their faces.
  void find_edges(const FeatureTrees& from, const FeatureTrees& to, const Eigen::Isometry3d& to_from,
                  double reach_m, std::vector<FeaturePair>& out);

 private:
  struct Entry {
    int node;
    unsigned lanes;
  };
  bool start(const FeatureTree& from, const FeatureTree& to, const Eigen::Isometry3d& to_from, double reach_m,
             std::vector<FeaturePair>& out);
  void descend(int node, std::size_t first, std::size_t last);
  void refine(Entry entry, const FeatureQuery& query, bool leaf);
  FeatureQuery query_of(const FeatureNode& node, int lane) const;
  void emit(const FeatureNode& node, int lane, std::size_t first);

  ReachTest reach_;
  EdgeTest cross_;
  // Of the current search.
  const FeatureTree *from_ = nullptr, *to_ = nullptr;
  const FeatureTrees *edges_from_ = nullptr, *edges_to_ = nullptr;
  Eigen::Matrix3f rotation_ = Eigen::Matrix3f::Identity();
  Eigen::Vector3f shift_{0, 0, 0};
  float reach_m_ = 0, slack_m_ = 0;
  std::vector<FeaturePair>* out_ = nullptr;
  std::vector<Entry> list_;
};

}  // namespace tactus::sim::features
