#include "sim_node/scene/meshes/mesh_file.h"

#include <stdexcept>

#include "sim_node/scene/meshes/mesh_reader.h"
#include "sim_node/model/triangles.h"

namespace tactus::sim {
namespace {

void append(const MeshPart& part, TriangleMesh& mesh) {
  const int first = static_cast<int>(mesh.vertices.size());
  for (const auto& p : part.positions_m) mesh.vertices.push_back(p.cast<double>());
  for (const auto& n : part.normals) mesh.normals.push_back(n.cast<double>().stableNormalized());
  for (const auto& t : part.texcoords) mesh.texcoords.push_back(t);
  for (const auto& t : part.tangents) mesh.tangents.push_back(t);
  for (const int i : part.indices) mesh.indices.push_back(first + i);
}

void scale_by(const Eigen::Vector3d& scale, TriangleMesh& mesh) {
  for (Eigen::Vector3d& v : mesh.vertices) v = v.cwiseProduct(scale);
  for (Eigen::Vector3d& n : mesh.normals) n = n.cwiseQuotient(scale).stableNormalized();
  if (scale != Eigen::Vector3d::Ones())
    for (Eigen::Vector4f& t : mesh.tangents)
      t.head<3>() = t.head<3>().cast<double>().cwiseProduct(scale).stableNormalized().cast<float>();
  if (scale.prod() > 0) return;
  // A reflection reverses the orientation of the triangles.
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) std::swap(mesh.indices[i + 1], mesh.indices[i + 2]);
  for (Eigen::Vector4f& t : mesh.tangents) t.w() = -t.w();
}

}  // namespace

bool is_selected(const MeshPart& part, const MeshSelection& selection) {
  return selection.submesh.empty() || selection.submesh == part.mesh || selection.submesh == part.node;
}

TriangleMesh join_parts(const MeshParts& parts, const MeshSelection& selection, const std::set<int>* only) {
  TriangleMesh mesh;
  Eigen::AlignedBox3d bounding_box;
  for (const MeshPart& part : parts.parts) {
    if (!is_selected(part, selection)) continue;
    for (const auto& p : part.positions_m) bounding_box.extend(p.cast<double>());
    if (!only || only->contains(part.material)) append(part, mesh);
  }
  if (mesh.indices.empty())
    throw std::runtime_error(selection.submesh.empty() ? "it has no triangle"
                                                       : "it has no submesh \"" + selection.submesh + "\"");
  if (mesh.texcoords.size() != mesh.vertices.size()) mesh.texcoords.clear();
  if (mesh.tangents.size() != mesh.vertices.size()) mesh.tangents.clear();
  if (selection.centre)
    for (Eigen::Vector3d& v : mesh.vertices) v -= bounding_box.center();
  scale_by(selection.scale, mesh);
  remove_degenerate(mesh);
  if (mesh.indices.empty()) throw std::runtime_error("all its triangles have zero area");
  complete_normals(mesh);
  return mesh;
}

TriangleMesh read_mesh(const std::filesystem::path& file, const std::string& submesh, bool centre,
                       const Eigen::Vector3d& scale) {
  return join_parts(read_mesh_parts(file), {submesh, centre, scale});
}

}  // namespace tactus::sim
