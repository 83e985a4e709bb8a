// The meshes of a scene: each file read once, and its triangles as they collide and as they are seen.
#pragma once

#include <filesystem>
#include <sdf/Mesh.hh>

#include "sim_node/scene/sdf/load_context.h"
#include "sim_node/scene/meshes/mesh_file.h"

namespace tactus::sim {

// What <mesh> names, checked.
struct NamedMesh {
  std::string uri;
  std::filesystem::path file;
  MeshChoice choice;
  const MeshParts* parts = nullptr;  // lives as long as the context
  std::string key;                   // who says the same means the same mesh
};

// `element` is the <mesh>. Refuses a scale that is none and a file that cannot be read.
NamedMesh named_mesh(LoadContext& context, const sdf::Mesh& mesh, const sdf::Element& element);

// All of it as one mesh, for whoever collides with it; index in WorldDef::meshes, as below.
int whole_mesh(LoadContext& context, const NamedMesh& named, const sdf::Element& element);

// As it is seen: the parts with these materials, with tangents where a picture lies on them, `subdivide` times
// finer.
int seen_mesh(LoadContext& context, const NamedMesh& named, const std::set<int>& materials, int subdivide,
              const sdf::Element& element);

// Index of the material that the file itself says it is made of, else `otherwise`.
int material_of_file(LoadContext& context, const NamedMesh& named, int otherwise);

}  // namespace tactus::sim
