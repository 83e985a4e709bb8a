#include "sim_node/model/triangles.h"

#include <algorithm>

namespace tactus::sim {
namespace {

using Index = std::size_t;

Eigen::Vector3d corner(const TriangleMesh& mesh, Index i) { return mesh.vertices[static_cast<Index>(mesh.indices[i])]; }

Eigen::Vector3d twice_area(const TriangleMesh& mesh, Index first) {
  const Eigen::Vector3d a = corner(mesh, first);
  return (corner(mesh, first + 1) - a).cross(corner(mesh, first + 2) - a);
}

}  // namespace

void remove_degenerate(TriangleMesh& mesh) {
  std::vector<int> kept;
  for (Index i = 0; i + 2 < mesh.indices.size(); i += 3)
    if (twice_area(mesh, i).norm() > 1e-18) kept.insert(kept.end(), {mesh.indices[i], mesh.indices[i + 1], mesh.indices[i + 2]});
  std::vector<int> renamed(mesh.vertices.size(), -1);
  TriangleMesh out;
  const auto keep = [&](const auto& from, Index old, auto& to) {
    if (from.size() == mesh.vertices.size()) to.push_back(from[old]);
  };
  for (int& index : kept) {
    const Index old = static_cast<Index>(index);
    if (renamed[old] < 0) {
      renamed[old] = static_cast<int>(out.vertices.size());
      out.vertices.push_back(mesh.vertices[old]);
      keep(mesh.normals, old, out.normals);
      keep(mesh.texcoords, old, out.texcoords);
      keep(mesh.tangents, old, out.tangents);
    }
    index = renamed[old];
  }
  out.indices = std::move(kept);
  mesh = std::move(out);
}

void complete_normals(TriangleMesh& mesh) {
  std::vector<Eigen::Vector3d> sums(mesh.vertices.size(), Eigen::Vector3d::Zero());
  for (Index i = 0; i + 2 < mesh.indices.size(); i += 3)
    for (Index k = 0; k < 3; ++k) sums[static_cast<Index>(mesh.indices[i + k])] += twice_area(mesh, i);
  mesh.normals.resize(mesh.vertices.size(), Eigen::Vector3d::Zero());
  for (Index v = 0; v < sums.size(); ++v) {
    const double norm = mesh.normals[v].norm();
    if (norm > 0.5 && norm < 2)
      mesh.normals[v] /= norm;
    else
      mesh.normals[v] = sums[v].norm() > 0 ? Eigen::Vector3d(sums[v].normalized()) : Eigen::Vector3d::UnitZ();
  }
}

Eigen::AlignedBox3d bounds(const TriangleMesh& mesh, const Eigen::Isometry3d& pose) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& v : mesh.vertices) box.extend(pose * v);
  return box;
}

VolumeIntegral integrate(const TriangleMesh& mesh) {
  VolumeIntegral result;
  Eigen::Vector3d first = Eigen::Vector3d::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();  // integral of x x^T
  for (Index i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const Eigen::Vector3d a = corner(mesh, i), b = corner(mesh, i + 1), c = corner(mesh, i + 2);
    const double volume = a.dot(b.cross(c)) / 6;
    result.volume_m3 += volume;
    const Eigen::Vector3d sum = a + b + c;
    first += volume / 4 * sum;
    second += volume / 20 * (a * a.transpose() + b * b.transpose() + c * c.transpose() + sum * sum.transpose());
  }
  if (result.volume_m3 == 0) return result;
  result.centroid_m = first / result.volume_m3;
  second -= result.volume_m3 * result.centroid_m * result.centroid_m.transpose();
  result.inertia = second.trace() * Eigen::Matrix3d::Identity() - second;
  return result;
}

TriangleMesh triangulate(const Heightfield& field, int max_samples) {
  TriangleMesh mesh;
  const int columns = std::min(field.columns, max_samples), rows = std::min(field.rows, max_samples);
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c) {
      const int from_row = r * (field.rows - 1) / (rows - 1), from_column = c * (field.columns - 1) / (columns - 1);
      const double u = double(from_column) / (field.columns - 1) - 0.5, v = double(from_row) / (field.rows - 1) - 0.5;
      const double height = field.heights_m[static_cast<Index>(from_row) * static_cast<Index>(field.columns) +
                                            static_cast<Index>(from_column)];
      mesh.vertices.push_back(field.centre_m + Eigen::Vector3d(u * field.size_m.x(), v * field.size_m.y(), height));
    }
  for (int r = 0; r + 1 < rows; ++r)
    for (int c = 0; c + 1 < columns; ++c) {
      const int i = r * columns + c;
      mesh.indices.insert(mesh.indices.end(), {i, i + 1, i + columns + 1, i, i + columns + 1, i + columns});
    }
  complete_normals(mesh);
  return mesh;
}

}  // namespace tactus::sim
