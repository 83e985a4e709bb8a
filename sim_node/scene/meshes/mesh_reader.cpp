#include "sim_node/scene/meshes/mesh_reader.h"

#include <algorithm>
#include <cmath>
#include <new>
#include <stdexcept>

#include "sim_node/scene/meshes/assimp_reader.h"
#include "sim_node/scene/meshes/gltf_reader.h"
#include "sync/sandbox/regular_file.h"

namespace tactus::sim {
namespace {

bool is_gltf(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  return extension == ".gltf" || extension == ".glb";
}

void check_sizes(const MeshPart& part, std::size_t materials) {
  const std::size_t count = part.positions_m.size();
  const auto fits = [&](const auto& list) { return list.empty() || list.size() == count; };
  if (part.normals.size() != count || !fits(part.texcoords) || !fits(part.tangents))
    throw std::runtime_error("its vertices have different numbers of normals, texture coordinates or tangents");
  if (part.indices.size() % 3 != 0) throw std::runtime_error("a triangle has no three corners");
  for (const int i : part.indices)
    if (i < 0 || static_cast<std::size_t>(i) >= count)
      throw std::runtime_error("an index refers to a vertex that does not exist");
  if (part.material < -1 || part.material >= static_cast<int>(materials))
    throw std::runtime_error("a part refers to a material that does not exist");
}

// Rejects values that are not possible for a position in a world or for a direction.
void check(MeshPart& part) {
  for (const Eigen::Vector3f& v : part.positions_m)
    if (!v.allFinite() || v.cwiseAbs().maxCoeff() > 1e6f) throw std::runtime_error("a vertex is not finite");
  for (const Eigen::Vector2f& t : part.texcoords)
    if (!t.allFinite() || t.cwiseAbs().maxCoeff() > 1e6f)
      throw std::runtime_error("a texture coordinate is not finite");
  for (Eigen::Vector3f& n : part.normals) {
    const float square = n.squaredNorm();
    if (!(square > 0) || !std::isfinite(square)) n.setZero();
    // Renormalizes normals of files with few digits. A normal that differs from unit length by rounding only is kept,
    // so that it is written unchanged.
    else if (std::abs(square - 1) > 1e-3f)
      n = n.cast<double>().stableNormalized().cast<float>();
  }
  for (Eigen::Vector4f& t : part.tangents) {
    if (!t.allFinite() || std::abs(t.head<3>().squaredNorm() - 1) > 1e-3f) {
      part.tangents.clear();  // all tangents are recomputed from the texture coordinates
      break;
    }
    t.w() = t.w() < 0 ? -1.0f : 1.0f;
  }
}

}  // namespace

void check_mesh_parts(MeshParts& mesh) {
  std::size_t corners = 0, vertices = 0;
  for (MeshPart& part : mesh.parts) {
    check_sizes(part, mesh.materials.size());
    check(part);
    corners += part.indices.size();
    vertices += part.positions_m.size();
  }
  if (corners / 3 > kMaxTriangles)
    throw std::runtime_error("it has more than " + std::to_string(kMaxTriangles) + " triangles: simplify it");
  if (vertices > kMaxVertices)
    throw std::runtime_error("it has more than " + std::to_string(kMaxVertices) + " vertices: simplify it");
}

MeshParts read_mesh_parts(const std::filesystem::path& file,
                          const std::vector<std::filesystem::path>& folders) try {
  sync::check_regular_file(file, kMaxMeshFileBytes);
  const sync::ReadableFolders readable(folders.empty() ? std::vector{file.parent_path()} : folders);
  MeshParts mesh = is_gltf(file) ? read_gltf(file, readable) : read_with_assimp(file, readable);
  check_mesh_parts(mesh);
  return mesh;
} catch (const std::bad_alloc&) {
  throw std::runtime_error("it needs more memory than is available");
}

}  // namespace tactus::sim
