#include "sim_node/collision/gaps/choose.h"

#include <algorithm>
#include <limits>

namespace tactus::sim::gaps {
namespace {

// A gap counts so many times its length: a point to which a body must turn by 27 degrees is none of this step;
// design.
constexpr double kGapWeight = 2;
// Of the extent of the contact, for normals that differ by one: less than half, so that a floor keeps three points
// beside one of a wall; design.
constexpr double kTurnWeight = 0.4;
constexpr double kSamePlace_m = 1e-6;

}  // namespace

void choose_points(std::span<const ManifoldPoint> found, Manifold& out) {
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
      if (nearest <= kSamePlace_m || nearest - behind(p) <= best_score) continue;
      best_score = nearest - behind(p);
      best = &p;
    }
    if (!best) return;
    out.points[static_cast<std::size_t>(out.count++)] = *best;
  }
}

}  // namespace tactus::sim::gaps
