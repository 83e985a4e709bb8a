#include "sim_node/collision/layers/overlap_lanes.h"

namespace tactus::sim {

unsigned overlap_avx2(const WideNode& node, const BoxQuery& query) { return overlap(node, query); }

}  // namespace tactus::sim
