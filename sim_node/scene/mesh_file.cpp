#include "sim_node/scene/mesh_file.h"

#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <assimp/Importer.hpp>
#include <functional>
#include <stdexcept>

#include "sim_node/scene/triangles.h"

namespace tactus::sim {
namespace {

// Beyond this neither an asset nor a collision query of a millisecond holds it.
constexpr std::size_t kMaxTriangles = 1'000'000;

// A change of direction above this angle is an edge, not a curve; degrees. Assimp's own choice is 175.
constexpr float kCrease_deg = 50;

struct Collector {
  TriangleMesh mesh;
  std::string submesh;

  void add(const aiScene& scene, const aiNode& node, const aiMatrix4x4& parent) {
    const aiMatrix4x4 pose = parent * node.mTransformation;
    for (unsigned m = 0; m < node.mNumMeshes; ++m) {
      const aiMesh& part = *scene.mMeshes[node.mMeshes[m]];
      if (submesh.empty() || submesh == part.mName.C_Str() || submesh == node.mName.C_Str()) add(part, pose);
    }
    for (unsigned c = 0; c < node.mNumChildren; ++c) add(scene, *node.mChildren[c], pose);
  }

  void add(const aiMesh& part, const aiMatrix4x4& pose) {
    const int first = static_cast<int>(mesh.vertices.size());
    aiMatrix3x3 turn(pose);
    const bool mirrored = turn.Determinant() < 0;
    turn.Inverse().Transpose();
    for (unsigned v = 0; v < part.mNumVertices; ++v) {
      const aiVector3D p = pose * part.mVertices[v];
      mesh.vertices.emplace_back(p.x, p.y, p.z);
      const aiVector3D n = part.HasNormals() ? turn * part.mNormals[v] : aiVector3D(0, 0, 0);
      mesh.normals.push_back(Eigen::Vector3d(n.x, n.y, n.z).stableNormalized());
    }
    for (unsigned f = 0; f < part.mNumFaces; ++f) {
      const aiFace& face = part.mFaces[f];
      if (face.mNumIndices != 3) continue;
      for (const int k : {0, mirrored ? 2 : 1, mirrored ? 1 : 2})
        mesh.indices.push_back(first + static_cast<int>(face.mIndices[k]));
    }
    if (mesh.indices.size() / 3 > kMaxTriangles)
      throw std::runtime_error("it has more than " + std::to_string(kMaxTriangles) + " triangles: simplify it");
  }
};

}  // namespace

TriangleMesh read_mesh(const std::filesystem::path& file, const std::string& submesh, bool centre,
                       const Eigen::Vector3d& scale) {
  Assimp::Importer importer;
  importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);  // z is up in SDF, as the numbers stand
  importer.SetPropertyFloat(AI_CONFIG_PP_GSN_MAX_SMOOTHING_ANGLE, kCrease_deg);
  const aiScene* scene = importer.ReadFile(file.string(), aiProcess_Triangulate | aiProcess_SortByPType |
                                                              aiProcess_GenSmoothNormals | aiProcess_JoinIdenticalVertices);
  if (!scene || !scene->mRootNode) throw std::runtime_error(importer.GetErrorString());
  Collector collector{{}, submesh};
  collector.add(*scene, *scene->mRootNode, aiMatrix4x4());
  TriangleMesh& mesh = collector.mesh;
  if (mesh.indices.empty())
    throw std::runtime_error(submesh.empty() ? "it holds no triangle" : "it has no submesh \"" + submesh + "\"");

  for (Eigen::Vector3d& v : mesh.vertices)
    if (!v.allFinite() || v.cwiseAbs().maxCoeff() > 1e6) throw std::runtime_error("a vertex is not finite");
  if (centre) {
    const Eigen::Vector3d middle = bounds(mesh, Eigen::Isometry3d::Identity()).center();
    for (Eigen::Vector3d& v : mesh.vertices) v -= middle;
  }
  for (Eigen::Vector3d& v : mesh.vertices) v = v.cwiseProduct(scale);
  for (Eigen::Vector3d& n : mesh.normals) n = n.cwiseQuotient(scale).stableNormalized();
  if (scale.prod() < 0)  // a mirror turns the triangles inside out
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) std::swap(mesh.indices[i + 1], mesh.indices[i + 2]);
  remove_degenerate(mesh);
  if (mesh.indices.empty()) throw std::runtime_error("all its triangles are without area");
  complete_normals(mesh);
  return mesh;
}

}  // namespace tactus::sim
