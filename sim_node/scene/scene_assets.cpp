#include "sim_node/scene/scene_assets.h"

#include <tactus/asset_ref_t.hpp>
#include <tactus/body_def_t.hpp>
#include <tactus/mesh_t.hpp>
#include <tactus/scene_t.hpp>
#include <tactus/shape_def_t.hpp>
#include <tactus/tool_def_t.hpp>
#include <tactus/visual_def_t.hpp>

#include "lcmtypes/vectors.h"
#include "sim_node/model/tool_shape.h"
#include "sim_node/model/triangles.h"
#include "sync/bus/decode.h"
#include "sync/bus/identity.h"

namespace tactus::sim {
namespace {

// Maximum samples per side of a displayed heightfield: 0.5 million triangles, 19 MB.
constexpr int kMaxSamples = 513;

mesh_t to_message(const TriangleMesh& mesh) {
  mesh_t m{};
  const auto append = [](const std::vector<Eigen::Vector3d>& from, std::vector<float>& to) {
    for (const Eigen::Vector3d& v : from)
      for (const int k : {0, 1, 2}) to.push_back(static_cast<float>(v[k]));
  };
  append(mesh.vertices, m.positions_m);
  append(mesh.normals, m.normals);
  m.vertex_floats = static_cast<std::int32_t>(m.positions_m.size());
  for (const Eigen::Vector2f& t : mesh.texcoords) m.texcoords.insert(m.texcoords.end(), t.data(), t.data() + 2);
  for (const Eigen::Vector4f& t : mesh.tangents) m.tangents.insert(m.tangents.end(), t.data(), t.data() + 4);
  m.texcoord_floats = static_cast<std::int32_t>(m.texcoords.size());
  m.tangent_floats = static_cast<std::int32_t>(m.tangents.size());
  m.indices.assign(mesh.indices.begin(), mesh.indices.end());
  m.index_count = static_cast<std::int32_t>(m.indices.size());
  return m;
}

struct Hashes {
  std::vector<std::int64_t> meshes, heightfields;
};

shape_def_t to_message(const ShapeDef& shape, const Hashes& hashes) {
  shape_def_t m{};
  m.name = shape.name;
  m.body = shape.body;
  m.pose = to_pose(shape.pose);
  m.size_m = to_vec3(shape.size_m);
  m.material = shape.material;
  const auto index = static_cast<std::size_t>(shape.mesh);
  switch (shape.kind) {
    case ShapeKind::kBox: m.kind = shape_def_t::BOX; break;
    case ShapeKind::kSphere: m.kind = shape_def_t::SPHERE; break;
    case ShapeKind::kCylinder: m.kind = shape_def_t::CYLINDER; break;
    case ShapeKind::kCapsule: m.kind = shape_def_t::CAPSULE; break;
    case ShapeKind::kPlane: m.kind = shape_def_t::PLANE; break;
    case ShapeKind::kMesh:
      m.kind = shape_def_t::MESH;
      m.mesh_hash = hashes.meshes[index];
      break;
    case ShapeKind::kHeightfield:
      m.kind = shape_def_t::MESH;
      m.mesh_hash = hashes.heightfields[index];
      break;
  }
  return m;
}

visual_def_t to_message(const VisualDef& visual, const Hashes& hashes) {
  visual_def_t m{};
  m.look = visual.look;
  m.shape = to_message(visual.shape, hashes);
  m.ambient = to_vec3f(visual.ambient), m.diffuse = to_vec3f(visual.diffuse);
  m.specular = to_vec3f(visual.specular), m.emissive = to_vec3f(visual.emissive);
  m.shininess = static_cast<float>(visual.shininess);
  m.alpha = static_cast<float>(visual.alpha);
  return m;
}

body_def_t to_message(const BodyDef& body, std::size_t index) {
  body_def_t m{};
  m.id = static_cast<std::int32_t>(index);
  m.name = body.name;
  m.is_static = body.is_static ? 1 : 0;
  m.tool = body.tool;
  m.mass_kg = body.is_static ? 0 : body.mass_kg;
  m.pose = to_pose(body.pose);
  return m;
}

scene_t to_message(const WorldDef& world, std::int64_t step_ns, const Hashes& hashes) {
  scene_t scene{};
  scene.name = world.name;
  scene.gravity_m_s2 = to_vec3(world.gravity_m_s2);
  scene.step_ns = step_ns;
  for (std::size_t i = 0; i < world.bodies.size(); ++i) scene.bodies.push_back(to_message(world.bodies[i], i));
  for (const ShapeDef& shape : world.shapes) scene.shapes.push_back(to_message(shape, hashes));
  for (const VisualDef& visual : world.visuals) scene.visuals.push_back(to_message(visual, hashes));
  scene.looks = world.looks, scene.shaders = world.shaders, scene.passes = world.passes;
  scene.environment_asset = world.environment_asset;
  scene.materials = world.materials, scene.lights = world.lights, scene.tools = world.tools;
  for (tool_def_t& tool : scene.tools)
    if (tool.shape == tool_def_t::MESH)
      tool.mesh_hash =
          hashes.meshes[static_cast<std::size_t>(tool_mesh(tool))];
  scene.settings = world.settings, scene.maps = world.maps;
  scene.camera = to_pose(world.camera), scene.camera_fov_rad = world.camera_fov_rad;
  scene.listener = to_pose(world.listener);
  scene.profile = world.profile;
  scene.ambient = to_vec3f(world.ambient), scene.background = to_vec3f(world.background);
  const auto count = [](const auto& list) { return static_cast<std::int32_t>(list.size()); };
  scene.body_count = count(scene.bodies), scene.shape_count = count(scene.shapes);
  scene.visual_count = count(scene.visuals), scene.material_count = count(scene.materials);
  scene.light_count = count(scene.lights), scene.tool_count = count(scene.tools);
  scene.look_count = count(scene.looks), scene.shader_count = count(scene.shaders), scene.pass_count = count(scene.passes);
  scene.setting_count = count(scene.settings), scene.map_count = count(scene.maps);
  return scene;
}

}  // namespace

std::vector<sync::Asset> make_assets(const WorldDef& world, std::int64_t step_ns) {
  std::vector<sync::Asset> assets(1);
  Hashes hashes;
  const auto add_mesh = [&](const TriangleMesh& mesh, const std::string& name) {
    sync::Asset asset{asset_ref_t::MESH, name, sync::encode(to_message(mesh))};
    const std::int64_t hash = sync::fnv1a_64(asset.bytes.data(), asset.bytes.size());
    assets.push_back(std::move(asset));
    return hash;
  };
  for (const TriangleMesh& mesh : world.meshes)
    hashes.meshes.push_back(add_mesh(mesh, "mesh " + std::to_string(hashes.meshes.size())));
  for (const Heightfield& field : world.heightfields)
    hashes.heightfields.push_back(
        add_mesh(triangulate(field, kMaxSamples), "heightfield " + std::to_string(hashes.heightfields.size())));
  assets.insert(assets.end(), world.images.begin(), world.images.end());
  assets.insert(assets.end(), world.shader_texts.begin(), world.shader_texts.end());
  assets.front() = {asset_ref_t::SCENE, world.name, sync::encode(to_message(world, step_ns, hashes))};
  if (!world.source_text.empty())
    assets.push_back({asset_ref_t::SDF, world.source_file, {world.source_text.begin(), world.source_text.end()}});
  return assets;
}

}  // namespace tactus::sim
