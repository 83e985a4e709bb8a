#include "sim_node/collision/gaps/select_points.h"

#include <algorithm>
#include <array>
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
// Normals within this angle of the nearest point of a face belong to the face. Cosine of 30 degrees. Design value: the
// facets of round surfaces stay together, floor and wall do not.
constexpr double kSameFace = 0.866;

// Whether a point belongs to a face that has been selected: the first point of each is in `firsts`.
bool belongs(const ManifoldPoint& p, std::span<const Eigen::Vector3d> firsts) {
  return std::any_of(firsts.begin(), firsts.end(), [&](const Eigen::Vector3d& n) { return p.normal.dot(n) > kSameFace; });
}

}  // namespace

void select_points(std::span<const ManifoldPoint> found, Manifold& out) {
  out.count = 0;
  std::array<Eigen::Vector3d, kMaxFaces> firsts;
  for (std::size_t face = 0; face < kMaxFaces; ++face) {
    const std::span<const Eigen::Vector3d> before(firsts.data(), face);
    const ManifoldPoint* deepest = nullptr;
    for (const ManifoldPoint& p : found)
      if ((!deepest || p.depth_m > deepest->depth_m) && !belongs(p, before)) deepest = &p;
    if (!deepest) return;
    firsts[face] = deepest->normal;
    const auto of_face = [&](const ManifoldPoint& p) { return p.normal.dot(deepest->normal) > kSameFace && !belongs(p, before); };
    const auto behind = [&](const ManifoldPoint& p) { return kGapWeight * (deepest->depth_m - p.depth_m); };
    double extent = 0;
    for (const ManifoldPoint& p : found)
      if (of_face(p)) extent = std::max(extent, (p.point_m - deepest->point_m).norm() - behind(p));
    const int begin = out.count;
    out.points[static_cast<std::size_t>(out.count++)] = *deepest;
    while (out.count < begin + kMaxFacePoints) {
      const ManifoldPoint* best = nullptr;
      double best_score = -std::numeric_limits<double>::max();
      for (const ManifoldPoint& p : found) {
        if (!of_face(p)) continue;
        double nearest = std::numeric_limits<double>::max();
        for (const ManifoldPoint& chosen : out.used().subspan(static_cast<std::size_t>(begin)))
          nearest = std::min(nearest, (p.point_m - chosen.point_m).norm() +
                                          kTurnWeight * extent * (p.normal - chosen.normal).norm());
        if (nearest <= kSamePosition_m || nearest - behind(p) <= best_score) continue;
        best_score = nearest - behind(p);
        best = &p;
      }
      if (!best) break;
      out.points[static_cast<std::size_t>(out.count++)] = *best;
    }
  }
}

}  // namespace tactus::sim::gaps
