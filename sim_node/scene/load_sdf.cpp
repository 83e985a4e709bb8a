#include "sim_node/scene/load_sdf.h"

#include <algorithm>
#include <new>
#include <stdexcept>

#include "sim_node/scene/bodies.h"
#include "sim_node/scene/lights.h"
#include "sim_node/scene/joints.h"
#include "sim_node/scene/sdf/tree.h"
#include "sim_node/scene/sdf/values.h"
#include "sim_node/scene/extensions/tactus_holes.h"
#include "sim_node/scene/extensions/tactus_looks.h"
#include "sim_node/scene/extensions/tactus_maps.h"
#include "sim_node/scene/extensions/tactus_materials.h"
#include "sim_node/scene/extensions/tactus_profile.h"
#include "sim_node/scene/extensions/tactus_settings.h"
#include "sim_node/scene/tactus_tools.h"
#include "sim_node/scene/unsupported.h"
#include "sim_node/scene/view.h"

namespace tactus::sim {
namespace {

// SDF's default (world.sdf).
const Eigen::Vector3d kDefaultGravity_m_s2(0, 0, -9.8);

// Built-in versions of the two models of every Gazebo installation, when the scene does not bring them.
void add_builtin_models(LoadContext& context) {
  for (const auto& skipped : context.files.skipped()) {
    if (skipped.uri == "model://sun") context.world.lights.push_back(sun());
    if (skipped.uri != "model://ground_plane" || context.body_of.contains("ground_plane::link")) continue;
    BodyDef body;
    body.name = "ground_plane::link";
    body.is_static = true;
    body.mass_kg = 0;
    ShapeDef plane;
    plane.name = "plane";
    plane.body = static_cast<int>(context.world.bodies.size());
    plane.kind = ShapeKind::kPlane;
    plane.size_m = {100, 100, 0};
    plane.friction = 1;
    context.body_of[body.name] = plane.body;
    context.world.bodies.push_back(body);
    context.world.shapes.push_back(plane);
    VisualDef visual;
    visual.shape = plane;
    context.world.visuals.push_back(visual);
  }
}

void read_gravity(LoadContext& context, const sdf::Element& world) {
  const sdf::Element* gravity = world.child("gravity");
  const Eigen::Vector3d value = gravity ? sdf::vector3(*gravity) : kDefaultGravity_m_s2;
  if (value.norm() > 1e4) context.reject(*gravity, "= " + std::string(gravity->text) + " is larger than 1e4 m/s^2");
  context.world.gravity_m_s2 = value;
}

void sort_no_collision(WorldDef& world) {
  auto& pairs = world.no_collision;
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
}

// world: the <world>, or the <sdf> of a file with only a model.
void read_world(LoadContext& context, const sdf::Element& world) {
  const Eigen::Isometry3d origin = Eigen::Isometry3d::Identity();
  read_materials(context, world);
  read_looks(context, world);
  if (world.name == "world") {
    read_gravity(context, world);
    for (const sdf::Element& light : world.children("light")) add_light(context, light, origin);
    for (const sdf::Element& model : world.children("model")) add_model(context, model, origin, "", false, -1);
    for (const sdf::Element& joint : world.children("joint")) add_joint(context, joint, origin, "");
  } else {
    add_model(context, *world.child("model"), origin, "", false, -1);
  }
  add_builtin_models(context);
  sort_no_collision(context.world);
  if (context.world.lights.empty()) context.world.lights.push_back(sun());
  read_view(context, world);
  read_tools(context, world);
  read_holes(context, world);
  read_settings(context, world);
  read_maps(context, world);
  read_profile(context, world);
}

const sdf::Element& world_of(const sdf::Element& root) {
  if (const sdf::Element* world = root.child("world")) return *world;
  if (!root.child("model"))
    throw std::runtime_error(sdf::where(root) + ": there is no <world> and no <model> in it");
  return root;
}

}  // namespace

WorldDef load_sdf(const std::filesystem::path& file, std::vector<std::string>& warnings,
                  const LoadOptions& options) try {
  const SdfFiles files(file, warnings, options.folders);
  const sdf::Tree tree(files, warnings);
  const sdf::Element& world = world_of(tree.root());
  sdf::Frames frames(world);
  WorldDef def;
  LoadContext context{files, frames, warnings, def, options.confined};
  for (const sdf::Element& other : tree.root().children(world.name))
    if (&other != &world) context.warn(other, "is a second world and has no effect");
  for (const sdf::Element& other : tree.root().children("model"))
    if (&other != tree.root().child("model")) context.warn(other, "is a second model and has no effect");
  def.name = world.name == "world" ? world.value("name") : world.child("model")->value("name");
  def.source_file = file.filename().string();
  def.source_text = files.main_text();
  read_world(context, world);
  warn_unsupported(context, tree.root());
  return def;
} catch (const std::runtime_error& e) {
  throw std::runtime_error(sdf::one_line(e.what()));
} catch (const std::bad_alloc&) {
  throw std::runtime_error(file.string() + ": the scene needs more memory than is available: simplify it");
}

}  // namespace tactus::sim
