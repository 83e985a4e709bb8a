// Meshes of a scene: reads each file once, and provides its triangles for collision and for display.
#pragma once

#include <filesystem>

#include "sim_node/scene/sdf/load_context.h"
#include "sim_node/scene/meshes/mesh_file.h"

namespace tactus::sim {

// The validated content of a <mesh> element.
struct NamedMesh {
  std::string uri;
  std::filesystem::path file;
  MeshSelection selection;
  const MeshParts* parts = nullptr;  // lives as long as the context
  std::string key;                   // equal keys refer to the same mesh
};

// `mesh`: the <mesh>. Rejects an invalid scale and an unreadable file.
NamedMesh named_mesh(LoadContext& context, const sdf::Element& mesh);

// The content of a geometry file; each file is read once. Throws std::runtime_error with one clause.
const MeshParts& mesh_parts(LoadContext& context, const std::filesystem::path& file);

// Appends a mesh to the world. Throws std::runtime_error with one clause when the scene has too many triangles.
void add_mesh(LoadContext& context, TriangleMesh mesh);

// The whole file as one mesh; returns its index in WorldDef::meshes.
int whole_mesh(LoadContext& context, const NamedMesh& named, const sdf::Element& element);

// The whole file as one mesh, for contact: its triangles face outwards (sim_node/model/mesh_solid.h), and a warning reports those
// that were turned. The same mesh as whole_mesh() if all faced outwards.
int collision_mesh(LoadContext& context, const NamedMesh& named, const sdf::Element& element);

// The mesh for display: the parts with these materials, with tangents where a picture is mapped onto them, subdivided
// `subdivide` times.
int display_mesh(LoadContext& context, const NamedMesh& named, const std::set<int>& materials, int subdivide,
              const sdf::Element& element);

// Index of the material that the file names, else `otherwise`.
int material_of_file(LoadContext& context, const NamedMesh& named, int otherwise);

}  // namespace tactus::sim
