// Content of a geometry file: parts of one material each, and the pictures of their materials.
#pragma once

#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

#include "sync/assets/asset.h"

namespace tactus::sim {

// A picture beside the mesh file, by its relative path, or the bytes of one inside it; neither: none.
struct MeshPicture {
  std::string file;
  sync::Bytes bytes;
  bool none() const { return file.empty() && bytes.empty(); }
  bool operator==(const MeshPicture&) const = default;
};

// Linear colours 0 .. 1; a Phong exponent and an opacity as in visual_def_t.
struct MeshMaterial {
  std::string name;
  Eigen::Vector3f diffuse{1, 1, 1}, specular{0.2f, 0.2f, 0.2f}, emissive{0, 0, 0};
  float shininess = 32, alpha = 1;
  MeshPicture colour_map, normal_map;
  bool operator==(const MeshMaterial&) const = default;
};

// Per vertex as in mesh_t.lcm, in the frame of the file, in single precision. Texture coordinates and tangents: one
// per position, or none. A missing normal is 0.
struct MeshPart {
  std::string mesh, node;
  int material = -1;  // index in MeshParts::materials; -1: none
  std::vector<Eigen::Vector3f> positions_m, normals;
  std::vector<Eigen::Vector2f> texcoords;
  std::vector<Eigen::Vector4f> tangents;
  std::vector<int> indices;
};

// Attributes of a Tactus element, by their names in docs/scene_format.md.
using Properties = std::map<std::string, std::string>;

struct MeshParts {
  std::vector<MeshPart> parts;
  std::vector<MeshMaterial> materials;
  // Properties of the object besides its geometry, in glTF only: of tactus:material and of tactus:look.
  Properties material, look;
};

// Limit for an asset, and for a collision query of a millisecond.
constexpr std::size_t kMaxTriangles = 1'000'000;

// More vertices than that number of triangles can use.
constexpr std::size_t kMaxVertices = 3 * kMaxTriangles;

// Parts and nodes of a file; a part takes 200 bytes even when it is empty (design).
constexpr std::size_t kMaxMeshParts = 100'000;

// Of all pictures inside a file: as many as a receiver accepts for a whole scene (sync/assets/scene_receiver.h).
constexpr std::size_t kMaxPictureBytes = std::size_t{256} << 20;

// Degrees; a larger change of direction is an edge, not a curve (design). Assimp's default is 175.
constexpr float kCrease_deg = 50;

}  // namespace tactus::sim
