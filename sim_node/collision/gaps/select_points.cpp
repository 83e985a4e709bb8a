#include "sim_node/collision/gaps/select_points.h"

#include <algorithm>
#include <limits>

namespace tactus::sim::gaps {
namespace {

// Weight of a gap against a distance. The value 2 excludes a point that the body reaches only by rotating 27
// degrees, more than in any step. Design value.
constexpr double kGapWeight = 2;
// Weight of a difference of normals, as a share of the contact's extent. Less than half, so that a floor keeps
// three points beside one point of a wall. Design value.
constexpr double kTurnWeight = 0.4;
constexpr double kSamePosition_m = 1e-6;

}  // namespace

void select_points(std::span<const ManifoldPoint> found, Manifold& out) {
  out.count = 0;
  if (found.empty()) return;
  const ManifoldPoint* deepest = found.data();
  for (const ManifoldPoint& p : found)
    if (p.depth_m > deepest->depth_m) deepest = &p;
  const auto behind = [&](const ManifoldPoint& p) { return kGapWeight * (deepest->depth_m - p.depth_m); };
  double extent = 0;
  for (const ManifoldPoint& p : found)
    extent = std::max(extent, (p.point_m - deepest->point_m).norm() - behind(p));
  out.points[static_cast<std::size_t>(out.count++)] = *deepest;
  while (out.count < kMaxManifoldPoints) {
    const ManifoldPoint* best = nullptr;
    double best_score = -std::numeric_limits<double>::max();
    for (const ManifoldPoint& p : found) {
      double nearest = std::numeric_limits<double>::max();
      for (const ManifoldPoint& chosen : out.used())
        nearest = std::min(nearest, (p.point_m - chosen.point_m).norm() +
                                        kTurnWeight * extent * (p.normal - chosen.normal).norm());
      if (nearest <= kSamePosition_m || nearest - behind(p) <= best_score) continue;
      best_score = nearest - behind(p);
      best = &p;
    }
    if (!best) return;
    out.points[static_cast<std::size_t>(out.count++)] = *best;
  }
}

}  // namespace tactus::sim::gaps
