#include "sim_node/collision/layers/mesh_check.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <utility>

namespace tactus::sim {
namespace {

std::string fault_of(std::span<const Eigen::Vector3d> vertices, std::span<const int> indices) {
  if (indices.empty()) return "it has no triangles";
  std::vector<std::pair<int, int>> edges;
  for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
    const int v[3] = {indices[i], indices[i + 1], indices[i + 2]};
    const std::string triangle = "triangle " + std::to_string(i / 3);
    if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0]) return triangle + " uses a vertex twice";
    const auto at = [&](int k) { return vertices[static_cast<std::size_t>(v[k])]; };
    if ((at(1) - at(0)).cross(at(2) - at(0)).isZero(0)) return triangle + " has no area";
    for (int k = 0; k < 3; ++k) edges.emplace_back(v[k], v[(k + 1) % 3]);
  }
  std::sort(edges.begin(), edges.end());
  const auto name = [](const std::pair<int, int>& e) {
    return "the edge from vertex " + std::to_string(e.first) + " to " + std::to_string(e.second);
  };
  for (std::size_t i = 0; i < edges.size(); ++i) {
    if (i > 0 && edges[i] == edges[i - 1]) return name(edges[i]) + " occurs twice in the same direction";
    if (!std::binary_search(edges.begin(), edges.end(), std::pair(edges[i].second, edges[i].first)))
      return name(edges[i]) + " has a triangle on one side only";
  }
  return "";
}

}  // namespace

MeshCheck check_mesh(std::span<const Eigen::Vector3d> vertices, std::span<const int> indices) {
  MeshCheck check;
  check.fault = fault_of(vertices, indices);
  if (!check.well_constructed()) return check;
  std::vector<std::vector<int>> at_vertex(vertices.size());
  const int count = static_cast<int>(indices.size() / 3);
  for (int i = 0; i < 3 * count; ++i)
    at_vertex[static_cast<std::size_t>(indices[static_cast<std::size_t>(i)])].push_back(i / 3);
  check.first.push_back(0);
  std::vector<int> around;
  for (int i = 0; i < count; ++i) {
    around.clear();
    for (int k = 0; k < 3; ++k) {
      const auto& more = at_vertex[static_cast<std::size_t>(indices[static_cast<std::size_t>(3 * i + k)])];
      around.insert(around.end(), more.begin(), more.end());
    }
    std::sort(around.begin(), around.end());
    around.erase(std::unique(around.begin(), around.end()), around.end());
    check.neighbours.insert(check.neighbours.end(), around.begin(), around.end());
    check.first.push_back(static_cast<int>(check.neighbours.size()));
  }
  return check;
}

}  // namespace tactus::sim
