// The oriented boxes of a mesh: layer 1 of I-Touch. Built top-down with one triangle a leaf (Gottschalk, Lin and
// Manocha 1996, OBBTree), then gathered to eight boxes a node, so that one test takes eight.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "sim_node/collision/layers/wide_node.h"

namespace tactus::sim {

struct Triangle {
  Eigen::Vector3d v[3];
  Eigen::Vector3d normal;  // unit, by the order of the vertices; zero where there is no area
  // Unit, in the plane and towards the inside, of the edges v[i] v[i+1]; zero where there is no area.
  Eigen::Vector3d inward[3];
};

// Plain after construction: any number of threads may query one tree.
class ObbTree {
 public:
  ObbTree() = default;
  // Any polygon soup: nothing is asked of the neighbourhood of its triangles. indices: three a triangle. Throws
  // std::runtime_error with one sentence when an index or a vertex makes no sense.
  ObbTree(std::span<const Eigen::Vector3d> vertices, std::span<const int> indices);

  // As given, degenerate ones included: the number of a triangle is its place in the indices.
  const std::vector<Triangle>& triangles() const { return triangles_; }
  // The first holds one box, around all. Centres are relative to origin().
  const std::vector<WideNode>& nodes() const { return nodes_; }
  const Eigen::Vector3d& origin() const { return origin_; }
  // No triangle is further than this from the origin, m.
  double radius_m() const { return radius_m_; }
  bool empty() const { return triangles_.empty(); }

 private:
  std::vector<Triangle> triangles_;
  std::vector<WideNode> nodes_;
  Eigen::Vector3d origin_{0, 0, 0};
  double radius_m_ = 0;
};

}  // namespace tactus::sim
