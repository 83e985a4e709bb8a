#include "sim_node/scene/meshes/assimp_reader.h"

#include <assimp/DefaultIOSystem.h>
#include <assimp/material.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "sim_node/scene/meshes/mesh_reader.h"
#include "sim_node/scene/sdf/regular_file.h"

namespace tactus::sim {
namespace {

// Opens regular files of bounded size only, because a material library may be named "/dev/zero".
class BoundedFiles : public Assimp::DefaultIOSystem {
 public:
  bool Exists(const char* file) const override { return may_open(file) && DefaultIOSystem::Exists(file); }
  Assimp::IOStream* Open(const char* file, const char* mode) override {
    return may_open(file) ? DefaultIOSystem::Open(file, mode) : nullptr;
  }

 private:
  static bool may_open(const char* file) try {
    check_regular_file(file, kMaxMeshFileBytes);
    return true;
  } catch (const std::runtime_error&) {
    return false;
  }
};

void check_triangle_count(std::size_t triangles) {
  if (triangles > kMaxTriangles)
    throw std::runtime_error("it has more than " + std::to_string(kMaxTriangles) + " triangles: simplify it");
}

// Assimp allocates the number of vertices in the header of a PLY file, which may be billions.
void check_counts(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::string line(256, 0);
  if (!in.read(line.data(), 3) || (line.substr(0, 3) != "ply" && line.substr(0, 3) != "PLY")) return;
  for (int n = 0; n < 1000 && in.getline(line.data(), static_cast<std::streamsize>(line.size())); ++n) {
    std::istringstream words(line.c_str());
    std::string word, name;
    double count = 0;
    words >> word;
    if (word == "end_header") return;
    if (word == "element" && words >> name >> count && !(count <= static_cast<double>(3 * kMaxTriangles)))
      throw std::runtime_error("its header declares more than " + std::to_string(3 * kMaxTriangles) + " of " + name);
  }
}

void add(const aiMesh& from, const aiNode& node, const aiMatrix4x4& pose, MeshParts& mesh) {
  MeshPart part;
  part.mesh = from.mName.C_Str(), part.node = node.mName.C_Str();
  part.material = static_cast<int>(from.mMaterialIndex);
  aiMatrix3x3 turn(pose);
  const bool mirrored = turn.Determinant() < 0;
  turn.Inverse().Transpose();
  const aiMatrix3x3 along(pose);
  const bool textured = from.HasTextureCoords(0),
             tangents = textured && from.HasTangentsAndBitangents() && from.HasNormals();
  for (unsigned v = 0; v < from.mNumVertices; ++v) {
    const aiVector3D p = pose * from.mVertices[v];
    const aiVector3D n = from.HasNormals() ? turn * from.mNormals[v] : aiVector3D(0, 0, 0);
    part.positions_m.emplace_back(p.x, p.y, p.z);
    part.normals.emplace_back(n.x, n.y, n.z);
    if (textured) part.texcoords.emplace_back(from.mTextureCoords[0][v].x, from.mTextureCoords[0][v].y);
    if (tangents) {
      const aiVector3D t = (along * from.mTangents[v]).NormalizeSafe(), b = along * from.mBitangents[v];
      part.tangents.emplace_back(t.x, t.y, t.z, (n ^ t) * b < 0 ? -1.0f : 1.0f);
    }
  }
  for (unsigned f = 0; f < from.mNumFaces; ++f) {
    const aiFace& face = from.mFaces[f];
    if (face.mNumIndices != 3) continue;
    for (const int k : {0, mirrored ? 2 : 1, mirrored ? 1 : 2})
      part.indices.push_back(static_cast<int>(face.mIndices[k]));
  }
  mesh.parts.push_back(std::move(part));
}

void add(const aiScene& scene, const aiNode& node, const aiMatrix4x4& parent, MeshParts& mesh,
         std::size_t& triangles) {
  const aiMatrix4x4 pose = parent * node.mTransformation;
  for (unsigned m = 0; m < node.mNumMeshes; ++m) {
    const aiMesh& part = *scene.mMeshes[node.mMeshes[m]];
    check_triangle_count(triangles += part.mNumFaces);
    add(part, node, pose, mesh);
  }
  for (unsigned c = 0; c < node.mNumChildren; ++c) add(scene, *node.mChildren[c], pose, mesh, triangles);
}

MeshPicture picture(const aiScene& scene, const aiMaterial& material, std::initializer_list<aiTextureType> types) {
  for (const aiTextureType type : types) {
    aiString path;
    if (material.GetTexture(type, 0, &path) != aiReturn_SUCCESS || path.length == 0) continue;
    if (const aiTexture* inside = scene.GetEmbeddedTexture(path.C_Str())) {
      // Height 0 marks a compressed file of mWidth bytes; otherwise raw pixels, which no documented format contains.
      if (inside->mHeight != 0) continue;
      const auto* bytes = reinterpret_cast<const std::uint8_t*>(inside->pcData);
      return {"", {bytes, bytes + inside->mWidth}};
    }
    std::string file = path.C_Str();
    std::replace(file.begin(), file.end(), '\\', '/');
    if (file.starts_with("./")) file.erase(0, 2);
    return {file, {}};
  }
  return {};
}

MeshMaterial read(const aiScene& scene, const aiMaterial& from) {
  MeshMaterial m;
  m.name = from.GetName().C_Str();
  const auto colour = [&](const char* key, unsigned type, unsigned index, Eigen::Vector3f& to) {
    aiColor3D c;
    if (from.Get(key, type, index, c) != aiReturn_SUCCESS) return;
    const Eigen::Vector3f rgb(c.r, c.g, c.b);
    if (rgb.allFinite()) to = rgb.cwiseMax(0).cwiseMin(1);
  };
  const auto number = [&](const char* key, unsigned type, unsigned index, float low, float high, float& to) {
    float value = 0;
    if (from.Get(key, type, index, value) == aiReturn_SUCCESS && std::isfinite(value))
      to = std::clamp(value, low, high);
  };
  colour(AI_MATKEY_COLOR_DIFFUSE, m.diffuse);
  colour(AI_MATKEY_COLOR_SPECULAR, m.specular);
  colour(AI_MATKEY_COLOR_EMISSIVE, m.emissive);
  float shininess = 0;
  number(AI_MATKEY_SHININESS, 0, 1e4f, shininess);
  if (shininess >= 1) m.shininess = shininess;
  number(AI_MATKEY_OPACITY, 0, 1, m.alpha);
  m.colour_map = picture(scene, from, {aiTextureType_BASE_COLOR, aiTextureType_DIFFUSE});
  m.normal_map = picture(scene, from, {aiTextureType_NORMAL_CAMERA, aiTextureType_NORMALS});
  return m;
}

// Assimp adds a default material to a file without materials; ignore it.
bool is_default_material(const MeshMaterial& m) {
  return (m.name.empty() || m.name == AI_DEFAULT_MATERIAL_NAME) && m.colour_map.none();
}

}  // namespace

MeshParts read_with_assimp(const std::filesystem::path& file) {
  Assimp::Importer importer;
  importer.SetIOHandler(new BoundedFiles);  // owned by the importer
  importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION,
                           true);  // keeps the coordinates: z is up in SDF
  importer.SetPropertyFloat(AI_CONFIG_PP_GSN_MAX_SMOOTHING_ANGLE, kCrease_deg);
  check_counts(file);
  const aiScene* scene = importer.ReadFile(file.string(), 0);
  std::size_t faces = 0;  // counted before processing: normals of millions of triangles take minutes
  for (unsigned m = 0; scene && m < scene->mNumMeshes; ++m) faces += scene->mMeshes[m]->mNumFaces;
  check_triangle_count(faces);
  if (scene)
    scene = importer.ApplyPostProcessing(aiProcess_Triangulate | aiProcess_SortByPType |
                                         aiProcess_GenSmoothNormals | aiProcess_JoinIdenticalVertices);
  if (!scene || !scene->mRootNode) throw std::runtime_error(importer.GetErrorString());
  MeshParts mesh;
  std::size_t triangles = 0;
  add(*scene, *scene->mRootNode, aiMatrix4x4(), mesh, triangles);
  std::vector<int> renamed;
  for (unsigned m = 0; m < scene->mNumMaterials; ++m) {
    MeshMaterial material = read(*scene, *scene->mMaterials[m]);
    renamed.push_back(is_default_material(material) ? -1 : static_cast<int>(mesh.materials.size()));
    if (renamed.back() >= 0) mesh.materials.push_back(std::move(material));
  }
  for (MeshPart& part : mesh.parts)
    part.material = static_cast<std::size_t>(part.material) < renamed.size()
                        ? renamed[static_cast<std::size_t>(part.material)]
                        : -1;
  return mesh;
}

}  // namespace tactus::sim
