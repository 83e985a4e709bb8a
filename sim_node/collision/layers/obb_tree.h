// Layer 1 of I-Touch: tree of oriented bounding boxes of a mesh. Built top-down with one triangle per leaf
// (Gottschalk, Lin and Manocha 1996, OBBTree), then collapsed to eight boxes per node, which are tested together.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "sim_node/collision/layers/wide_node.h"

namespace tactus::sim {

struct Triangle {
  Eigen::Vector3d v[3];
  Eigen::Vector3d normal;  // unit, by the order of the vertices; zero for zero area
  // Unit vectors in the plane, normal to the edges v[i] v[i+1], inward; zero for zero area.
  Eigen::Vector3d inward[3];
  // Whether the edge v[i] v[i+1] is inside a flat face, which continues beyond it.
  bool inner[3] = {false, false, false};
};

// Immutable after construction: any number of threads may query one tree.
class ObbTree {
 public:
  ObbTree() = default;
  // Accepts any polygon soup; adjacency is not needed. indices: three per triangle. Throws std::runtime_error with
  // one sentence when an index or a vertex is invalid.
  ObbTree(std::span<const Eigen::Vector3d> vertices, std::span<const int> indices);

  // In the given order, degenerate ones included: the index of a triangle is its position in the indices.
  const std::vector<Triangle>& triangles() const { return triangles_; }
  // The first node holds one box around the whole mesh. Centres are relative to origin().
  const std::vector<WideNode>& nodes() const { return nodes_; }
  const Eigen::Vector3d& origin() const { return origin_; }
  // Bounding radius around origin(), m.
  double radius_m() const { return radius_m_; }
  bool empty() const { return triangles_.empty(); }

 private:
  std::vector<Triangle> triangles_;
  std::vector<WideNode> nodes_;
  Eigen::Vector3d origin_{0, 0, 0};
  double radius_m_ = 0;
};

}  // namespace tactus::sim
