#include "sim_node/model/manifold.h"

#include <algorithm>
#include <limits>

namespace tactus::sim {
namespace {

// Distance per radian between two points with one position and different normals, as in a corner, m. Smaller than any
// patch and larger than the distance of duplicates.
constexpr double kNormalWeight_m = 1e-3;
constexpr double kSamePosition_m = 1e-6;

double apart(const ManifoldPoint& a, const ManifoldPoint& b) {
  return (a.point_m - b.point_m).norm() + kNormalWeight_m * (a.normal - b.normal).norm();
}

}  // namespace

void reduce_points(std::span<const ManifoldPoint> found, Manifold& out) {
  out.count = 0;
  if (found.empty()) return;
  const auto deepest = std::max_element(found.begin(), found.end(), [](const ManifoldPoint& a, const ManifoldPoint& b) {
    return a.depth_m < b.depth_m;
  });
  out.points[static_cast<std::size_t>(out.count++)] = *deepest;
  while (out.count < kMaxFacePoints) {
    const ManifoldPoint* best = nullptr;
    double best_distance = kSamePosition_m;
    for (const ManifoldPoint& p : found) {
      double nearest = std::numeric_limits<double>::max();
      for (const ManifoldPoint& chosen : out.used()) nearest = std::min(nearest, apart(p, chosen));
      if (nearest > best_distance) {
        best_distance = nearest;
        best = &p;
      }
    }
    if (!best) return;
    out.points[static_cast<std::size_t>(out.count++)] = *best;
  }
}

}  // namespace tactus::sim
