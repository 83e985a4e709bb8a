// Checks whether a mesh is well-constructed, for algorithms that use the adjacency of its triangles.
#pragma once

#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace tactus::sim {

struct MeshCheck {
  std::string fault;  // one sentence; empty: closed, and every edge is shared by two triangles in opposite directions
  // For each triangle, itself and the triangles that share a vertex with it, ascending: neighbours[first[i]] up to
  // first[i + 1]. Only for a well-constructed mesh.
  std::vector<int> first, neighbours;

  bool well_constructed() const { return fault.empty(); }
  std::span<const int> around(int triangle) const {
    const auto i = static_cast<std::size_t>(triangle);
    return {neighbours.data() + first[i], neighbours.data() + first[i + 1]};
  }
};

// Vertices are compared by index: a soup with duplicate vertices is not well-constructed.
MeshCheck check_mesh(std::span<const Eigen::Vector3d> vertices, std::span<const int> indices);

}  // namespace tactus::sim
