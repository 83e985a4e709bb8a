#include "sim_node/collision/features/feature_lanes.h"

namespace tactus::sim::features {

unsigned reach_avx512(const FeatureNode& node, const FeatureQuery& query) { return reach(node, query); }

unsigned cross_avx512(const FeatureNode& node, const EdgeLanes& edges, const EdgeQuery& query) {
  return cross_edges(node, edges, query);
}

}  // namespace tactus::sim::features
