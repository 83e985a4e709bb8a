// The contacts of two meshes that every search must find.
#pragma once

#include <algorithm>
#include <vector>

#include "sim_node/collision/gaps/mesh_pair.h"
#include "sim_node/collision/triangle_tree.h"
#include "sim_node/model/point_pair.h"
#include "tests/sim_node/support/meshes.h"

namespace tactus::sim::test {

class ExpectedPairs {
 public:
  ExpectedPairs(const Soup& a, const Soup& b)
      : a_(a), b_(b), tree_a_(a.vertices, a.indices), tree_b_(b.vertices, b.indices) {}

  // Whether the pair, with b in the world frame, is a local minimum of the distance, a vertex over a face without
  // a much nearer point beside it, or an overlap. The other contacts of the search over all triangles are edges
  // over faces: they lie between vertices over the same face.
  bool expected(const PointPair& p, const Eigen::Isometry3d& pose_a) const {
    if (p.gap_m <= 0) return true;
    const Eigen::Isometry3d back = pose_a.inverse(Eigen::Isometry);
    const Eigen::Vector3d in_a = back * p.on_a_m;
    const auto around_a = [&](double share) {
      return gaps::nearest_around(tree_a_, back * p.on_b_m, in_a, share);
    };
    const auto around_b = [&](double share) { return gaps::nearest_around(tree_b_, p.on_a_m, p.on_b_m, share); };
    if (around_a(1) && around_b(1)) return true;
    const bool vertex_a = is_vertex(a_, in_a), vertex_b = is_vertex(b_, p.on_b_m);
    return (vertex_a && !vertex_b && is_inside(b_, p.triangle_b, p.on_b_m) && around_a(0.9)) ||
           (vertex_b && !vertex_a && is_inside(a_, p.triangle_a, in_a) && around_b(0.9));
  }

 private:
  static bool is_vertex(const Soup& s, const Eigen::Vector3d& at) {
    return std::any_of(s.vertices.begin(), s.vertices.end(),
                       [&](const Eigen::Vector3d& v) { return (v - at).norm() < 1e-9; });
  }
  // Within the face, away from its edges.
  static bool is_inside(const Soup& s, int triangle, const Eigen::Vector3d& at) {
    const Eigen::Vector3d &a = s.corner(triangle, 0), &b = s.corner(triangle, 1), &c = s.corner(triangle, 2);
    const Eigen::Vector3d n = (b - a).cross(c - a);
    return (b - a).cross(at - a).dot(n) > 1e-9 * n.norm() && (c - b).cross(at - b).dot(n) > 1e-9 * n.norm() &&
           (a - c).cross(at - c).dot(n) > 1e-9 * n.norm();
  }

  const Soup &a_, &b_;
  TriangleTree tree_a_, tree_b_;
};

}  // namespace tactus::sim::test
