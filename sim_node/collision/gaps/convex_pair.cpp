#include "sim_node/collision/gaps/convex_pair.h"

#include <algorithm>

#include "sim_node/collision/gaps/feature.h"
#include "sim_node/collision/gaps/nearest_points.h"
#include "sim_node/collision/gaps/separating_axis.h"

namespace tactus::sim::gaps {

using Eigen::Isometry3d;
using Eigen::Vector3d;

namespace {

// A corner represents the least gap when its gap is equal within this, m.
constexpr double kSame_m = 1e-9;

ContactKind kind_of(const FacingPoints& found) {
  return found.count > 2 ? ContactKind::kSurface : found.count == 2 ? ContactKind::kEdge : ContactKind::kPoint;
}

double min_gap_m(const FacingPoints& found) {
  double gap = 1e300;
  for (int i = 0; i < found.count; ++i) gap = std::min(gap, found.at[static_cast<std::size_t>(i)].gap_m);
  return gap;
}

// Converts points on cores, frame of a, to points on surfaces, world frame.
void append(const FacingPoints& found, const Vector3d& n, const Isometry3d& pose_a, double round_a, double round_b,
            std::vector<PointPair>& out) {
  PointPair p;
  p.normal = pose_a.linear() * n;
  p.kind = kind_of(found);
  for (int i = 0; i < found.count; ++i) {
    const FacingPoint& f = found.at[static_cast<std::size_t>(i)];
    p.on_a_m = pose_a * (f.on_a + round_a * n);
    p.on_b_m = pose_a * (f.on_b - round_b * n);
    p.gap_m = f.gap_m - round_a - round_b;
    out.push_back(p);
  }
}

}  // namespace

void convex_pair(const Convex& a, const Isometry3d& pose_a, const Convex& b, const Isometry3d& pose_b,
                 double reach_m, std::vector<PointPair>& out) {
  const Isometry3d a_from_b = pose_a.inverse(Eigen::Isometry) * pose_b;
  const double rounds = a.round_m + b.round_m, reach = reach_m + rounds;
  FacingPoints found;
  const auto corners = [&](const Vector3d& n) {
    facing(feature_along(a, Isometry3d::Identity(), n), feature_along(b, a_from_b, -n), n, reach, found);
  };
  // Most contacts are a face against a feature above it. A corner over the face then has the least gap.
  const SeparatingAxis face = best_face_axis(a, b, a_from_b);
  if (face.gap_m > reach) return;
  if (face.gap_m > -kTouching_m) {
    corners(face.along);
    if (min_gap_m(found) <= face.gap_m + kSame_m)
      return append(found, face.along, pose_a, a.round_m, b.round_m, out);
  }
  NearestPoints near;
  const Proximity apart = nearest_points(a, b, a_from_b, reach, near);
  if (apart == Proximity::kFar) return;
  Vector3d n;
  FacingPoint nearest;
  if (apart == Proximity::kNear) {
    n = (near.on_b - near.on_a) / near.distance_m;
    nearest = {near.on_a, near.on_b, near.distance_m};
  } else {
    const SeparatingAxis axis = overlap_axis(a, b, a_from_b);
    n = axis.along;
    const Vector3d on_a = support(a, n), on_b = a_from_b * support(b, a_from_b.linear().transpose() * -n);
    // The support points of crossing edges are not at the crossing. Their midpoint is at least at the right height.
    Vector3d flat = (on_a + on_b) / 2;
    flat -= flat.dot(n) * n;
    nearest = {flat + on_a.dot(n) * n, flat + on_b.dot(n) * n, axis.gap_m};
    if (axis.gap_m > reach) return;
  }
  corners(n);
  if (min_gap_m(found) > nearest.gap_m + kSame_m) found.add(nearest);
  append(found, n, pose_a, a.round_m, b.round_m, out);
}

void over_face(const Convex& a, const Isometry3d& pose_a, const Convex& triangle, const Isometry3d& pose_b,
               double reach_m, std::vector<PointPair>& out) {
  const Isometry3d a_from_b = pose_a.inverse(Eigen::Isometry) * pose_b;
  const auto& t = triangle.corners_m;
  const Vector3d across = (t[1] - t[0]).cross(t[2] - t[0]);
  if (across.isZero()) return;
  Vector3d n = a_from_b.linear() * across.normalized();
  if (n.dot(a_from_b * t[0]) < 0) n = -n;
  FacingPoints found;
  facing(feature_along(a, Isometry3d::Identity(), n), feature_along(triangle, a_from_b, -n), n,
         reach_m + a.round_m, found);
  // Points beside the triangle may be below its plane. That is not an overlap.
  FacingPoints above;
  for (int i = 0; i < found.count; ++i)
    if (found.at[static_cast<std::size_t>(i)].gap_m >= 0) above.add(found.at[static_cast<std::size_t>(i)]);
  append(above, n, pose_a, a.round_m, 0, out);
}

void plane_pair(const Isometry3d& plane_pose, const Convex& b, const Isometry3d& pose_b, double reach_m,
                std::vector<PointPair>& out) {
  const Vector3d n = plane_pose.linear().col(2).normalized();
  const double offset = n.dot(plane_pose.translation());
  FacingPoints found;
  facing_plane(feature_along(b, pose_b, -n), n, offset, reach_m + b.round_m, found);
  append(found, n, Isometry3d::Identity(), 0, b.round_m, out);
}

}  // namespace tactus::sim::gaps
