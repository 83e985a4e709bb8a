// Is a mesh well constructed? What may rely on the neighbourhood of its triangles asks here first.
#pragma once

#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace tactus::sim {

struct MeshCheck {
  std::string fault;  // one sentence; empty: closed, every edge shared by two triangles that run it opposite ways
  // Of each triangle, itself and those that share a vertex with it, ascending: neighbours[first[i]] up to first[i
  // + 1]. Only of a well constructed mesh.
  std::vector<int> first, neighbours;

  bool well_constructed() const { return fault.empty(); }
  std::span<const int> around(int triangle) const {
    const auto i = static_cast<std::size_t>(triangle);
    return {neighbours.data() + first[i], neighbours.data() + first[i + 1]};
  }
};

// Vertices count by their index: a soup with doubled vertices is not well constructed.
MeshCheck check_mesh(std::span<const Eigen::Vector3d> vertices, std::span<const int> indices);

}  // namespace tactus::sim
