// The distance of two meshes, for tests that place one near the other.
#pragma once

#include <algorithm>

#include "sim_node/collision/layers/mesh_contact.h"

namespace tactus::sim::test {

// Minimum distance of a and b, m; 0 in overlap. Widens the tolerance of a query until it finds a pair.
inline double least_gap_m(const ContactMesh& a, const ContactMesh& b, const Eigen::Isometry3d& pose_b) {
  MeshContact contact;
  MeshContactResult found;
  const double apart_m = (pose_b * b.tree.origin() - a.tree.origin()).norm() - a.tree.radius_m() - b.tree.radius_m();
  for (double reach_m = std::max(1e-4, 1.01 * apart_m); found.pairs.empty(); reach_m *= 1.2)
    contact.query(a, Eigen::Isometry3d::Identity(), b, pose_b, {reach_m, reach_m}, found);
  double least = found.pairs.front().gap_m;
  for (const PointPair& p : found.pairs) least = std::min(least, p.gap_m);
  return least;
}

}  // namespace tactus::sim::test
