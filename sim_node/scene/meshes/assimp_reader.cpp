#include "sim_node/scene/meshes/assimp_reader.h"

#include <assimp/DefaultIOSystem.h>
#include <assimp/MemoryIOWrapper.h>
#include <assimp/material.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <cctype>
#include <assimp/Importer.hpp>
#include <fstream>
#include <iterator>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string_view>

#include "sim_node/scene/meshes/assimp_reason.h"
#include "sim_node/scene/meshes/collada_size.h"
#include "sim_node/scene/meshes/mesh_reader.h"
#include "sim_node/scene/meshes/obj_text.h"
#include "sync/sandbox/regular_file.h"

namespace tactus::sim {
namespace {

constexpr int kMaxNodeDepth = 256;  // as in gltf_reader.cpp

// Opens regular files of bounded size below the readable folders only, because a material library may be named
// "/dev/zero" or "../../.ssh/id_rsa".
class BoundedFiles : public Assimp::DefaultIOSystem {
 public:
  BoundedFiles(std::filesystem::path main, const sync::ReadableFolders& readable, std::string& outside)
      : main_(std::move(main)), readable_(readable), outside_(outside) {}
  bool Exists(const char* file) const override { return may_open(file) && DefaultIOSystem::Exists(file); }
  Assimp::IOStream* Open(const char* file, const char* mode) override {
    if (!may_open(file)) return nullptr;
    Assimp::IOStream* completed = open_completed(file);
    return completed ? completed : DefaultIOSystem::Open(file, mode);
  }

 private:
  bool may_open(const char* file) const try {
    if (file != main_) {
      std::error_code error;
      if (!std::filesystem::is_regular_file(file, error)) return false;
      if (!readable_.resolve(file)) {
        outside_ = std::filesystem::path(file).filename().string();
        return false;
      }
    }
    sync::check_regular_file(file, kMaxMeshFileBytes);
    return true;
  } catch (const std::runtime_error&) {
    return false;
  }

  // Null: the file is neither OBJ nor MTL, or is read as it is.
  static Assimp::IOStream* open_completed(const char* file) {
    std::string ending = std::filesystem::path(file).extension().string();
    std::ranges::transform(ending, ending.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    std::ifstream in(file, std::ios::binary);
    if ((ending != ".obj" && ending != ".mtl") || !in) return nullptr;
    std::string text{std::istreambuf_iterator<char>(in), {}};
    if (!complete_obj_text(text)) return nullptr;
    auto copy = std::make_unique<std::uint8_t[]>(text.size());
    std::ranges::copy(text, copy.get());
    return new Assimp::MemoryIOStream(copy.release(), text.size(), true);  // both are owned by the importer
  }

  std::filesystem::path main_;
  const sync::ReadableFolders& readable_;
  std::string& outside_;  // a file that exists, but may not be read
};

// Totals of a file. Its nodes may show one mesh many times, so they are counted before their vertices are copied.
struct Totals {
  std::size_t triangles = 0, vertices = 0, nodes = 0;

  void check() const {
    if (triangles > kMaxTriangles)
      throw std::runtime_error("it has more than " + std::to_string(kMaxTriangles) + " triangles: simplify it");
    if (vertices > kMaxVertices)
      throw std::runtime_error("it has more than " + std::to_string(kMaxVertices) + " vertices: simplify it");
    if (nodes > kMaxMeshParts)
      throw std::runtime_error("it has more than " + std::to_string(kMaxMeshParts) + " nodes and parts: simplify it");
  }
  void add(const aiMesh& mesh) {
    triangles += mesh.mNumFaces, vertices += mesh.mNumVertices, ++nodes;
    check();
  }
  // depth: levels above the node. Post-processing and the copy below call themselves for each level.
  void add(const aiScene& scene, const aiNode& node, int depth) {
    ++nodes;
    check();
    if (depth > kMaxNodeDepth)
      throw std::runtime_error("its nodes are nested deeper than " + std::to_string(kMaxNodeDepth) + " levels");
    for (unsigned m = 0; m < node.mNumMeshes; ++m) add(*scene.mMeshes[node.mMeshes[m]]);
    for (unsigned c = 0; c < node.mNumChildren; ++c) add(scene, *node.mChildren[c], depth + 1);
  }
};

// Assimp allocates the number of vertices in the header of a PLY file, which may be billions.
void check_counts(const std::filesystem::path& file) {
  constexpr std::size_t kMaxHeader = 64 << 10;
  std::string head(kMaxHeader, '\0');
  std::ifstream in(file, std::ios::binary);
  in.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(in.gcount()));
  const auto is = [&](std::size_t at, char c) { return head[at] == c || head[at] == c - 'a' + 'A'; };
  if (head.size() < 3 || !is(0, 'p') || !is(1, 'l') || !is(2, 'y')) return;
  std::replace(head.begin(), head.end(), '\r', '\n');
  std::istringstream lines(head);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string word, name;
    double count = 0;
    words >> word;
    if (word == "end_header") return;
    if (word == "element" && !(words >> name >> count && count >= 0 && count <= static_cast<double>(kMaxVertices)))
      throw std::runtime_error("its header declares more than " + std::to_string(kMaxVertices) + " of " + name.substr(0, 64));
  }
  throw std::runtime_error("it is a PLY file whose header has no end within " + std::to_string(kMaxHeader >> 10) + " KiB");
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

void add(const aiScene& scene, const aiNode& node, const aiMatrix4x4& parent, MeshParts& mesh) {
  const aiMatrix4x4 pose = parent * node.mTransformation;
  for (unsigned m = 0; m < node.mNumMeshes; ++m) add(*scene.mMeshes[node.mMeshes[m]], node, pose, mesh);
  for (unsigned c = 0; c < node.mNumChildren; ++c) add(scene, *node.mChildren[c], pose, mesh);
}

// bytes: total of all pictures inside the file. A file may name one picture many times.
MeshPicture picture(const aiScene& scene, const aiMaterial& material, std::initializer_list<aiTextureType> types,
                    std::size_t& bytes_so_far) {
  for (const aiTextureType type : types) {
    aiString path;
    if (material.GetTexture(type, 0, &path) != aiReturn_SUCCESS || path.length == 0) continue;
    if (const aiTexture* inside = scene.GetEmbeddedTexture(path.C_Str())) {
      // Height 0 marks a compressed file of mWidth bytes; otherwise raw pixels, which no documented format contains.
      if (inside->mHeight != 0) continue;
      if ((bytes_so_far += inside->mWidth) > kMaxPictureBytes)
        throw std::runtime_error("its pictures are larger than " + std::to_string(kMaxPictureBytes >> 20) + " MiB together");
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

MeshMaterial read(const aiScene& scene, const aiMaterial& from, std::size_t& picture_bytes) {
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
  m.colour_map = picture(scene, from, {aiTextureType_BASE_COLOR, aiTextureType_DIFFUSE}, picture_bytes);
  m.normal_map = picture(scene, from, {aiTextureType_NORMAL_CAMERA, aiTextureType_NORMALS}, picture_bytes);
  return m;
}

// Assimp adds a default material to a file without materials; ignore it.
bool is_default_material(const MeshMaterial& m) {
  return (m.name.empty() || m.name == AI_DEFAULT_MATERIAL_NAME) && m.colour_map.none();
}

// The readers of PLY and of others pass on any index, and the post-processing relies on them.
void check_indices(const aiScene& scene) {
  for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
    const aiMesh& mesh = *scene.mMeshes[m];
    for (unsigned f = 0; f < mesh.mNumFaces; ++f)
      for (unsigned k = 0; k < mesh.mFaces[f].mNumIndices; ++k)
        if (mesh.mFaces[f].mIndices[k] >= mesh.mNumVertices)
          throw std::runtime_error("face " + std::to_string(f + 1) + " names a vertex that the file does not hold; export it again");
  }
}

bool has_surface(const aiScene& scene) {
  for (unsigned m = 0; m < scene.mNumMeshes; ++m)
    for (unsigned f = 0; f < scene.mMeshes[m]->mNumFaces; ++f)
      if (scene.mMeshes[m]->mFaces[f].mNumIndices >= 3) return true;
  return false;
}

}  // namespace

MeshParts read_with_assimp(const std::filesystem::path& file, const sync::ReadableFolders& readable) {
  check_counts(file);
  check_collada(file);
  std::string outside;
  Assimp::Importer importer;
  importer.SetIOHandler(new BoundedFiles(file, readable, outside));  // owned by the importer
  importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION,
                           true);  // keeps the coordinates: z is up in SDF
  importer.SetPropertyFloat(AI_CONFIG_PP_GSN_MAX_SMOOTHING_ANGLE, kCrease_deg);
  const aiScene* scene = importer.ReadFile(file.string(), 0);
  if (!outside.empty())
    throw std::runtime_error("it names \"" + outside.substr(0, 200) + "\", which is hidden or outside the folder of the scene");
  if (scene && scene->mRootNode) {
    if (!has_surface(*scene)) throw std::runtime_error(kNoSurface);
    check_indices(*scene);
    // Counted before processing: normals of millions of triangles take minutes.
    Totals all, shown;
    for (unsigned m = 0; m < scene->mNumMeshes; ++m) all.add(*scene->mMeshes[m]);
    shown.add(*scene, *scene->mRootNode, 0);
    scene = importer.ApplyPostProcessing(aiProcess_Triangulate | aiProcess_SortByPType |
                                         aiProcess_GenSmoothNormals | aiProcess_JoinIdenticalVertices);
  }
  if (!scene || !scene->mRootNode) throw std::runtime_error(assimp_reason(file, importer.GetErrorString()));
  Totals shown;  // again, because polygons have become triangles
  shown.add(*scene, *scene->mRootNode, 0);
  MeshParts mesh;
  add(*scene, *scene->mRootNode, aiMatrix4x4(), mesh);
  std::size_t picture_bytes = 0;
  std::vector<int> renamed;
  for (unsigned m = 0; m < scene->mNumMaterials; ++m) {
    MeshMaterial material = read(*scene, *scene->mMaterials[m], picture_bytes);
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
