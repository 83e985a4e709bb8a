#include "sim_node/scene/meshes.h"

#include <functional>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "sim_node/model/mesh_solid.h"
#include "sim_node/scene/meshes/confined_reader.h"
#include "sim_node/scene/meshes/mesh_reader.h"
#include "sim_node/scene/sdf/values.h"
#include "sim_node/scene/meshes/subdivide.h"
#include "sim_node/scene/extensions/tactus_materials.h"
#include "sim_node/scene/meshes/tangents.h"

namespace tactus::sim {
namespace {

// Of all meshes of a scene: each scale of a file is a mesh of its own, so that a scene of a kilobyte could need any amount
// of memory. Twice the limit of one file; more do not fit into the assets that a receiver accepts.
constexpr std::size_t kMaxSceneTriangles = 2 * kMaxTriangles;

int add(LoadContext& context, const std::string& key, const NamedMesh& named, const sdf::Element& element,
        const std::function<TriangleMesh()>& make) {
  const auto [at, is_new] = context.mesh_of.try_emplace(key, static_cast<int>(context.world.meshes.size()));
  if (is_new) try {
      add_mesh(context, make());
    } catch (const std::exception& e) {
      context.reject(element, "names mesh \"" + named.uri + "\", which cannot be read: " + e.what());
    }
  return at->second;
}

// Fills missing texture coordinates when other parts have them: the corner of the picture is used.
void fill_texcoords(MeshPart& part) {
  if (part.texcoords.empty()) part.texcoords.assign(part.positions_m.size(), Eigen::Vector2f(0, 0));
  make_tangents(part);
}

MeshPart part_of(const TriangleMesh& mesh) {
  MeshPart part;
  for (const auto& v : mesh.vertices) part.positions_m.push_back(v.cast<float>());
  for (const auto& n : mesh.normals) part.normals.push_back(n.cast<float>());
  part.texcoords = mesh.texcoords, part.indices = mesh.indices;
  return part;
}

TriangleMesh make_display_mesh(const NamedMesh& named, const std::set<int>& materials, int times) {
  MeshParts chosen;
  bool textured = false;
  for (const MeshPart& part : named.parts->parts)
    if (is_selected(part, named.selection)) {
      chosen.parts.push_back(part);
      textured = textured || (!part.texcoords.empty() && materials.contains(part.material));
    }
  if (textured)
    for (MeshPart& part : chosen.parts) fill_texcoords(part);
  TriangleMesh mesh = join_parts(chosen, named.selection, &materials);
  if (times == 0) return mesh;
  mesh = subdivide(mesh, times);
  if (!textured) return mesh;
  MeshParts finer;
  finer.parts.push_back(part_of(mesh));
  make_tangents(finer.parts.front());
  return join_parts(finer, {});
}

std::string facing_sentence(const std::string& uri, const TurnedTriangles& found) {
  const auto count = [](std::size_t n, const char* what) { return std::to_string(n) + " " + what + (n == 1 ? "" : "s"); };
  std::string did;
  if (found.turned > 0)
    did = count(found.turned, "triangle") + (found.shells > 0 ? " facing inwards" : " facing the other side than the neighbours") +
          (found.turned == 1 ? " is turned" : " are turned");
  if (found.repeated > 0)
    did += (did.empty() ? "" : " and ") + count(found.repeated, "repeated triangle") + (found.repeated == 1 ? " is" : " are") + " left out";
  return "names mesh \"" + uri + "\", of which " + did + " for contact; let the faces of the file point outwards";
}

}  // namespace

NamedMesh named_mesh(LoadContext& context, const sdf::Element& mesh) {
  const sdf::Element* uri = mesh.child("uri");
  if (!uri || uri->text.empty()) context.reject(mesh, "lacks its <uri>");
  const sdf::Element* submesh = mesh.child("submesh");
  const sdf::Element* submesh_name = sdf::child_of(submesh, "name");
  if (submesh && (!submesh_name || submesh_name->text.empty())) context.reject(*submesh, "lacks its <name>");
  NamedMesh named{std::string(uri->text),
                  context.asset_file(std::string(uri->text), mesh),
                  {std::string(submesh_name ? submesh_name->text : ""), sdf::child_flag(submesh, "center", false),
                   sdf::child_vector3(&mesh, "scale", {1, 1, 1})},
                  nullptr,
                  ""};
  const Eigen::Vector3d& scale = named.selection.scale;
  if ((scale.array() == 0).any() || scale.cwiseAbs().maxCoeff() > 1e6)
    context.reject(mesh, "has a <scale> that is zero or larger than 1e6");
  std::ostringstream key;
  key << named.file.string() << '|' << named.selection.submesh << '|' << named.selection.centre << '|' << scale.transpose();
  named.key = key.str();
  try {
    named.parts = &mesh_parts(context, named.file);
  } catch (const std::exception& e) {
    context.reject(mesh, "names mesh \"" + named.uri + "\", which cannot be read: " + e.what());
  }
  return named;
}

const MeshParts& mesh_parts(LoadContext& context, const std::filesystem::path& file) {
  auto& parts = context.mesh_files[file.string()];
  const auto& folders = context.files.readable().folders();
  if (!parts)
    parts = std::make_shared<const MeshParts>(context.confined ? read_mesh_parts_confined(file, folders)
                                                               : read_mesh_parts(file, folders));
  return *parts;
}

void add_mesh(LoadContext& context, TriangleMesh mesh) {
  if ((context.mesh_corners += mesh.indices.size()) / 3 > kMaxSceneTriangles)
    throw std::runtime_error("with it the scene has more than " + std::to_string(kMaxSceneTriangles) +
                             " triangles: simplify it, or use fewer sizes of it");
  context.world.meshes.push_back(std::move(mesh));
}

int whole_mesh(LoadContext& context, const NamedMesh& named, const sdf::Element& element) {
  return add(context, named.key, named, element, [&] { return join_parts(*named.parts, named.selection); });
}

int collision_mesh(LoadContext& context, const NamedMesh& named, const sdf::Element& element) {
  const std::string key = named.key + "|outwards";
  if (const auto known = context.mesh_of.find(key); known != context.mesh_of.end()) return known->second;
  const int whole = whole_mesh(context, named, element);
  TriangleMesh mesh = context.world.meshes[static_cast<std::size_t>(whole)];
  const TurnedTriangles found = turn_outwards(mesh);
  if (found.any()) context.warn(element, facing_sentence(named.uri, found));
  return found.any() ? add(context, key, named, element, [&] { return std::move(mesh); }) : context.mesh_of[key] = whole;
}

int display_mesh(LoadContext& context, const NamedMesh& named, const std::set<int>& materials, int subdivide,
              const sdf::Element& element) {
  std::string key = named.key + "|seen|" + std::to_string(subdivide);
  for (const int material : materials) key += "|" + std::to_string(material);
  return add(context, key, named, element, [&] { return make_display_mesh(named, materials, subdivide); });
}

int material_of_file(LoadContext& context, const NamedMesh& named, int otherwise) {
  if (named.parts->material.empty()) return otherwise;
  const auto [at, is_new] = context.material_of_file.try_emplace(named.file.string(), -1);
  if (is_new) at->second = define_material(context, named.parts->material, named.file);
  return at->second;
}

}  // namespace tactus::sim
