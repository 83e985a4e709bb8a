#include "sim_node/collision/nearest_first.h"

#include <algorithm>

#include "sim_node/collision/detector.h"

namespace tactus::sim {

using Eigen::Isometry3d;

void nearest_first_of_all(Detector& detector, int a, const Isometry3d& pose_a, int b, const Isometry3d& pose_b,
                          double reach_m, PairVisitor& visitor, std::vector<PointPair>& scratch) {
  detector.query(a, pose_a, b, pose_b, reach_m, scratch);
  std::stable_sort(scratch.begin(), scratch.end(),
                   [](const PointPair& x, const PointPair& y) { return x.gap_m < y.gap_m; });
  for (const PointPair& p : scratch)
    if (!visitor.is_redundant(p) && !visitor.visit(p)) return;
}

void prepare_nearest_first(Detector& detector, int a, int b) {
  if (auto* quicker = dynamic_cast<NearestFirstDetector*>(&detector)) quicker->prepare_nearest_first(a, b);
}

void nearest_first(Detector& detector, int a, const Isometry3d& pose_a, int b, const Isometry3d& pose_b,
                   double reach_m, PairVisitor& visitor, std::vector<PointPair>& scratch) {
  auto* quicker = dynamic_cast<NearestFirstDetector*>(&detector);
  if (quicker && quicker->nearest_first(a, pose_a, b, pose_b, reach_m, visitor, scratch)) return;
  nearest_first_of_all(detector, a, pose_a, b, pose_b, reach_m, visitor, scratch);
}

}  // namespace tactus::sim
