#include "sim_node/scene/load_sdf.h"

#include <algorithm>
#include <new>
#include <sdf/World.hh>
#include <stdexcept>

#include "sim_node/scene/bodies.h"
#include "sim_node/scene/lights.h"
#include "sim_node/scene/sdf/sdf_eigen.h"
#include "sim_node/scene/sdf/sdf_read.h"
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

void read_gravity(LoadContext& context, const sdf::World& world) {
  const Eigen::Vector3d gravity = to_eigen(world.Gravity());
  if (!gravity.allFinite() || gravity.norm() > 1e4)
    context.reject(*world.Element(), "has a <gravity> that is not finite");
  context.world.gravity_m_s2 = gravity;
}

void sort_no_collision(WorldDef& world) {
  auto& pairs = world.no_collision;
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
}

void read_world(LoadContext& context, const sdf::World* world, const sdf::Model* model, const sdf::ElementPtr& element) {
  read_materials(context, element);
  read_looks(context, element);
  if (world) {
    read_gravity(context, *world);
    for (std::uint64_t i = 0; i < world->LightCount(); ++i)
      add_light(context, *world->LightByIndex(i), Eigen::Isometry3d::Identity());
    for (std::uint64_t i = 0; i < world->ModelCount(); ++i)
      add_model(context, *world->ModelByIndex(i), Eigen::Isometry3d::Identity(), "", false, -1);
  } else {
    add_model(context, *model, Eigen::Isometry3d::Identity(), "", false, -1);
  }
  add_builtin_models(context);
  sort_no_collision(context.world);
  if (context.world.lights.empty()) context.world.lights.push_back(sun());
  read_view(context, world, element);
  read_tools(context, element);
  read_holes(context, element);
  read_settings(context, element);
  read_maps(context, element);
  read_profile(context, element);
}

}  // namespace

WorldDef load_sdf(const std::filesystem::path& file, std::vector<std::string>& warnings,
                  const LoadOptions& options) try {
  const SdfFiles files(file, warnings, options.folders);
  const auto root = read_sdf(files);
  const sdf::World* world = root->WorldByIndex(0);
  const sdf::Model* model = root->Model();
  if (!world && !model)
    throw std::runtime_error(files.where(*root->Element()) + ": there is no <world> and no <model> in it");
  WorldDef def;
  LoadContext context{files, warnings, def, {}, {}, {}, nullptr};
  context.confined = options.confined;
  if (root->WorldCount() > 1) context.warn(*root->WorldByIndex(1)->Element(), "is a second world and has no effect");
  def.name = world ? world->Name() : model->Name();
  def.source_file = file.filename().string();
  def.source_text = files.main_text();
  read_world(context, world, model, world ? world->Element() : root->Element());
  warn_unsupported(context, root->Element());
  return def;
} catch (const std::bad_alloc&) {
  throw std::runtime_error(file.string() + ": the scene needs more memory than is available: simplify it");
}

}  // namespace tactus::sim
