#include "sim_node/scene/meshes/tangents.h"

#include <Eigen/Geometry>
#include <cmath>

namespace tactus::sim {
namespace {

using Index = std::size_t;

// Any direction in the plane of the surface, where the texture coordinates give none.
Eigen::Vector3d perpendicular(const Eigen::Vector3d& n) {
  const Eigen::Vector3d axis = std::abs(n.x()) < 0.8 ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitY();
  return (axis - n * n.dot(axis)).stableNormalized();
}

double angle(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

}  // namespace

void make_tangents(MeshPart& part) {
  const Index count = part.positions_m.size();
  if (!part.tangents.empty() || part.texcoords.size() != count || part.normals.size() != count) return;
  const auto at = [&](Index corner) { return static_cast<Index>(part.indices[corner]); };
  // For each vertex, sums of directions over triangles with unmirrored and with mirrored texture coordinates.
  std::vector<Eigen::Vector3d> sums[2] = {{count, Eigen::Vector3d::Zero()}, {count, Eigen::Vector3d::Zero()}};
  std::vector<char> mirrored;
  for (Index t = 0; t + 2 < part.indices.size(); t += 3) {
    Eigen::Vector3d p[3];
    Eigen::Vector2d uv[3];
    for (Index k = 0; k < 3; ++k)
      p[k] = part.positions_m[at(t + k)].cast<double>(), uv[k] = part.texcoords[at(t + k)].cast<double>();
    const Eigen::Vector3d e1 = p[1] - p[0], e2 = p[2] - p[0];
    const Eigen::Vector2d d1 = uv[1] - uv[0], d2 = uv[2] - uv[0];
    const double area = d1.x() * d2.y() - d2.x() * d1.y();
    mirrored.push_back(area < 0);
    if (area == 0) continue;
    const Eigen::Vector3d direction = ((e1 * d2.y() - e2 * d1.y()) / area).stableNormalized();
    if (!direction.allFinite()) continue;
    for (Index k = 0; k < 3; ++k) {
      const Eigen::Vector3d n = part.normals[at(t + k)].cast<double>();
      const double weight = angle(p[(k + 1) % 3] - p[k], p[(k + 2) % 3] - p[k]);
      sums[area < 0][at(t + k)] += weight * (direction - n * n.dot(direction)).stableNormalized();
    }
  }
  // A vertex with triangles of both orientations is split in two.
  std::vector<char> used[2] = {std::vector<char>(count), std::vector<char>(count)};
  for (Index c = 0; c < mirrored.size() * 3; ++c) used[static_cast<Index>(mirrored[c / 3])][at(c)] = 1;
  const auto tangent = [&](Index v, int side) {
    const Eigen::Vector3d n = part.normals[v].cast<double>(), sum = sums[side][v];
    const Eigen::Vector3f t = (sum.norm() > 1e-9 ? sum.normalized() : perpendicular(n)).cast<float>();
    return Eigen::Vector4f(t.x(), t.y(), t.z(), side ? -1.0f : 1.0f);
  };
  std::vector<int> twin(count, -1);
  for (Index v = 0; v < count; ++v) part.tangents.push_back(tangent(v, used[1][v] && !used[0][v]));
  for (Index c = 0; c < mirrored.size() * 3; ++c) {
    const Index v = at(c);
    if (!mirrored[c / 3] || !used[0][v]) continue;
    if (twin[v] < 0) {
      twin[v] = static_cast<int>(part.positions_m.size());
      part.positions_m.push_back(Eigen::Vector3f(part.positions_m[v]));
      part.normals.push_back(Eigen::Vector3f(part.normals[v]));
      part.texcoords.push_back(Eigen::Vector2f(part.texcoords[v]));
      part.tangents.push_back(tangent(v, 1));
    }
    part.indices[c] = twin[v];
  }
}

}  // namespace tactus::sim
