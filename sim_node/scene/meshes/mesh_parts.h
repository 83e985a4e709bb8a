// What a geometry file holds, as it stands there: parts of one material each, and the pictures that their
// materials name.
#pragma once

#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

#include "sync/assets/scene_exchange.h"

namespace tactus::sim {

// A picture beside the mesh file, by its path from there, or the bytes of one inside it; neither: none.
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

// Per vertex as in mesh_t.lcm, in the frame of the file, single precision as files have it. Texture coordinates
// and tangents are as many as positions, or none; a normal that the file lacks is 0.
struct MeshPart {
  std::string mesh, node;
  int material = -1;  // index in MeshParts::materials; -1: none
  std::vector<Eigen::Vector3f> positions_m, normals;
  std::vector<Eigen::Vector2f> texcoords;
  std::vector<Eigen::Vector4f> tangents;
  std::vector<int> indices;
};

// Attributes of an element of ours, by their names in docs/scene_format.md.
using Properties = std::map<std::string, std::string>;

struct MeshParts {
  std::vector<MeshPart> parts;
  std::vector<MeshMaterial> materials;
  // What the file says of the object beyond its geometry, in glTF only: of tactus:material and of tactus:look.
  Properties material, look;
};

// Beyond this neither an asset nor a collision query of a millisecond holds it.
constexpr std::size_t kMaxTriangles = 1'000'000;

// A change of direction above this angle is an edge, not a curve; degrees (design). Assimp's own choice is 175.
constexpr float kCrease_deg = 50;

}  // namespace tactus::sim
