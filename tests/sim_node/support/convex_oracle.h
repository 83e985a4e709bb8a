// Proof of the distance of convex shapes by bounds: a pair of points on both is an upper bound, and the gap between
// the supporting planes along any direction is a lower bound. Written from the definition of each shape.
#pragma once

#include <Eigen/Geometry>
#include <cmath>

#include "sim_node/model/world_def.h"
#include "tests/sim_node/support/meshes.h"

namespace tactus::sim::test {

// Support distance of the shape along a unit direction of the world.
inline double reach_along(const ShapeDef& s, const Eigen::Isometry3d& pose, const Eigen::Vector3d& n) {
  const Eigen::Vector3d d = pose.linear().transpose() * n;
  const double middle = n.dot(pose.translation());
  switch (s.kind) {
    case ShapeKind::kBox: return middle + 0.5 * d.cwiseAbs().dot(s.size_m);
    case ShapeKind::kSphere: return middle + s.size_m.x();
    case ShapeKind::kCapsule: return middle + s.size_m.x() + 0.5 * s.size_m.z() * std::abs(d.z());
    default: return middle + s.size_m.x() * std::hypot(d.x(), d.y()) + 0.5 * s.size_m.z() * std::abs(d.z());
  }
}

// Gap between the supporting planes, a's and then b's along n; negative: overlap.
inline double gap_along(const ShapeDef& a, const Eigen::Isometry3d& pose_a, const ShapeDef& b,
                        const Eigen::Isometry3d& pose_b, const Eigen::Vector3d& n) {
  return -reach_along(b, pose_b, -n) - reach_along(a, pose_a, n);
}

// Whether a world point lies in the shape, within a tolerance.
inline bool lies_in(const ShapeDef& s, const Eigen::Isometry3d& pose, const Eigen::Vector3d& point,
                    double within_m) {
  const Eigen::Vector3d p = pose.inverse() * point;
  const double up = std::abs(p.z()) - 0.5 * s.size_m.z(), out = std::hypot(p.x(), p.y()) - s.size_m.x();
  switch (s.kind) {
    case ShapeKind::kBox: return (p.cwiseAbs() - 0.5 * s.size_m).maxCoeff() <= within_m;
    case ShapeKind::kSphere: return p.norm() <= s.size_m.x() + within_m;
    case ShapeKind::kCapsule:
      return (p - Eigen::Vector3d(0, 0, std::clamp(p.z(), -0.5 * s.size_m.z(), 0.5 * s.size_m.z()))).norm() <=
             s.size_m.x() + within_m;
    default: return std::max(up, out) <= within_m;
  }
}

// The widest gap over many directions, refined from the best: a tight lower bound of the distance. Slow, and
// independent of the library's search.
inline double widest_gap(const ShapeDef& a, const Eigen::Isometry3d& pose_a, const ShapeDef& b,
                         const Eigen::Isometry3d& pose_b, Random& random) {
  Eigen::Vector3d best = Eigen::Vector3d::UnitX();
  double gap = -1e300;
  for (int i = 0; i < 4000; ++i) {
    const double size = i < 400 ? 10.0 : std::pow(10.0, -5.0 * (i - 400) / 3600);
    const Eigen::Vector3d n = (best + size * direction(random)).normalized();
    const double g = gap_along(a, pose_a, b, pose_b, n);
    if (g > gap) gap = g, best = n;
  }
  return gap;
}

}  // namespace tactus::sim::test
