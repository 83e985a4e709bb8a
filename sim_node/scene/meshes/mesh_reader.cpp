#include "sim_node/scene/meshes/mesh_reader.h"

#include <algorithm>
#include <cmath>
#include <new>
#include <stdexcept>

#include "sim_node/scene/meshes/assimp_reader.h"
#include "sim_node/scene/meshes/gltf_reader.h"
#include "sim_node/scene/sdf/regular_file.h"

namespace tactus::sim {
namespace {

bool is_gltf(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  return extension == ".gltf" || extension == ".glb";
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

MeshParts read_mesh_parts(const std::filesystem::path& file) try {
  check_regular_file(file, kMaxMeshFileBytes);
  MeshParts mesh = is_gltf(file) ? read_gltf(file) : read_with_assimp(file);
  std::size_t indices = 0;
  for (MeshPart& part : mesh.parts) {
    check(part);
    indices += part.indices.size();
  }
  if (indices / 3 > kMaxTriangles)
    throw std::runtime_error("it has more than " + std::to_string(kMaxTriangles) + " triangles: simplify it");
  return mesh;
} catch (const std::bad_alloc&) {
  throw std::runtime_error("it needs more memory than is available");
}

}  // namespace tactus::sim
