#include "sim_node/scene/bodies.h"

#include <algorithm>
#include <limits>
#include <span>
#include <tactus/material_def_t.hpp>

#include "sim_node/scene/inertial.h"
#include "sim_node/scene/joints.h"
#include "sim_node/scene/lights.h"
#include "sim_node/scene/meshes.h"
#include "sim_node/scene/sdf/values.h"
#include "sim_node/scene/shapes.h"
#include "sim_node/scene/extensions/tactus_materials.h"
#include "sim_node/scene/visuals.h"

namespace tactus::sim {
namespace {

// SDF's default (surface.sdf): friction 1 and no restitution.
constexpr double kDefaultFriction = 1;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Pairs of links of all models that do not collide with each other: 80 MB. A model of 4,000 links has 8 million.
constexpr std::size_t kMaxPairs = 10'000'000;
// Limits of initial velocities: above those of any scene that a step of 1 ms can resolve. Design values.
constexpr double kMaxSpeed_m_s = 1000, kMaxSpin_rad_s = 10000;

double in_range(const sdf::Element& element, double value, double min, double max) {
  if (!(value >= min && value <= max))
    sdf::reject(element, "= " + std::string(element.text) + " is out of range");
  return value;
}

// Values in SDF take precedence over those of the material. collision: nullptr for a shape that no element describes.
void read_surface(const LoadContext& context, const sdf::Element* collision, int inherited, ShapeDef& shape) {
  shape.material = surface_material(context, collision, inherited);
  shape.friction = kDefaultFriction;
  if (shape.material >= 0) {
    const material_def_t& material = context.world.materials[static_cast<std::size_t>(shape.material)];
    shape.friction = material.friction_dynamic, shape.restitution = material.restitution;
  }
  const sdf::Element* surface = sdf::child_of(collision, "surface");
  if (const auto* mu = sdf::child_of(sdf::child_of(sdf::child_of(surface, "friction"), "ode"), "mu"))
    shape.friction = std::min(in_range(*mu, sdf::number_or_infinity(*mu), 0, kInfinity), 1e6);
  if (const auto* bounce = sdf::child_of(sdf::child_of(surface, "bounce"), "restitution_coefficient"))
    shape.restitution = in_range(*bounce, sdf::number(*bounce), 0, 1);
}

// Planes and heightmaps are made for the ground. On a body that moves, a plane is a thin plate, and neither touches another ground.
void warn_of_moving_ground(const LoadContext& context, const sdf::Element& link) {
  for (const sdf::Element& collision : link.children("collision")) {
    const sdf::Element* geometry = collision.child("geometry");
    for (const char* kind : {"plane", "heightmap"})
      if (sdf::child_of(geometry, kind))
        context.warn(collision, "is a " + std::string(kind) + " of a body that moves: it does not touch other planes and heightmaps; set <static> of the model, or use a " +
                                    (kind == std::string_view("plane") ? "<box>" : "<mesh>"));
  }
}

// Material that the mesh file names; -1: none.
int file_material(LoadContext& context, const sdf::Element& collision) {
  const sdf::Element* mesh = sdf::child_of(collision.child("geometry"), "mesh");
  if (!mesh || collision.child("tactus:surface")) return -1;
  return material_of_file(context, named_mesh(context, *mesh), -1);
}

void add_collisions(LoadContext& context, const sdf::Element& link, int body, int material) {
  for (const sdf::Element& collision : link.children("collision")) {
    auto shape = read_shape(context, collision, context.resolve(collision));
    if (!shape) continue;
    shape->name = collision.value("name");
    shape->body = body;
    read_surface(context, &collision, material < 0 ? file_material(context, collision) : material, *shape);
    context.world.shapes.push_back(*shape);
  }
}

// A body with visuals but no collision gets the bounding box of its visuals, and every plane among them. Nothing collides
// as a mesh that is not there.
void add_bounding_box(LoadContext& context, std::size_t first_visual, int body, int material) {
  ShapeDef box;
  Eigen::AlignedBox3d bounding_box;
  bool has_visual = false;
  for (std::size_t i = first_visual; i < context.world.visuals.size(); ++i) {
    if (context.placeholders.contains(i)) continue;
    has_visual = true;
    const ShapeDef& shape = context.world.visuals[i].shape;
    bounding_box.extend(bounds(context.world, shape));
    if (shape.kind == ShapeKind::kPlane) box = shape;
    if (material < 0) material = shape.material;
  }
  if (!has_visual) return;
  box.name = "bounding_box", box.body = body;
  if (!bounding_box.isEmpty()) {
    box.kind = ShapeKind::kBox;
    box.pose = Eigen::Translation3d(bounding_box.center()) * Eigen::Isometry3d::Identity();
    box.size_m = bounding_box.sizes().cwiseMax(1e-4);  // a flat mesh has no thickness
  }
  read_surface(context, nullptr, material, box);
  context.world.shapes.push_back(box);
}

void find_camera(LoadContext& context, const sdf::Element& link, const Eigen::Isometry3d& pose) {
  for (const sdf::Element& sensor : link.children("sensor")) {
    if (context.camera_sensor || sensor.value("type") != "camera" || !sensor.child("camera")) continue;
    context.camera_sensor = &sensor;
    context.camera_sensor_pose = pose * context.resolve(sensor);
  }
}

// Three numbers of an element of a link, for example <tactus:velocity>1 0 0.5</tactus:velocity>; zero without it.
Eigen::Vector3d initial_rate(const sdf::Element& link, std::string_view name, double max) {
  const sdf::Element* given = link.child(name);
  if (!given) return {0, 0, 0};
  const Eigen::Vector3d rate = sdf::vector3(*given);
  if (!(rate.norm() <= max))
    sdf::reject(*given, "= \"" + std::string(given->text) + "\" must be at most " + std::to_string(static_cast<long>(max)) + " as a vector");
  return rate;
}

int add_link(LoadContext& context, const sdf::Element& link, const Eigen::Isometry3d& model_pose, const std::string& scope,
             bool is_static, int inherited) {
  const int index = static_cast<int>(context.world.bodies.size());
  const int material = surface_material(context, &link, inherited);
  BodyDef body;
  body.name = scope + std::string(link.value("name"));
  body.is_static = is_static;
  body.pose = model_pose * context.resolve(link);
  const std::size_t first_shape = context.world.shapes.size(), first_visual = context.world.visuals.size();
  if (!is_static) warn_of_moving_ground(context, link);
  add_collisions(context, link, index, material);
  add_visuals(context, link, index, material);
  if (first_shape == context.world.shapes.size() && first_visual < context.world.visuals.size())
    add_bounding_box(context, first_visual, index, material);
  read_inertial(context, link, std::span(context.world.shapes).subspan(first_shape), body);
  body.gravity = sdf::child_flag(&link, "gravity", body.gravity);
  if (const auto* decay = link.child("velocity_decay")) {
    const auto damping = [&](const char* name) {
      const sdf::Element* given = decay->child(name);
      return given ? in_range(*given, sdf::number(*given), 0, 1e6) : 0.0;
    };
    body.linear_damping_1_s = damping("linear"), body.angular_damping_1_s = damping("angular");
  }
  body.velocity_m_s = initial_rate(link, "tactus:velocity", kMaxSpeed_m_s);
  body.spin_rad_s = initial_rate(link, "tactus:spin", kMaxSpin_rad_s);
  find_camera(context, link, body.pose);
  for (const sdf::Element& light : link.children("light")) {
    if (!is_static) context.warn(light, "stays where it is when its link moves");
    add_light(context, light, body.pose);
  }
  context.body_of[body.name] = index;
  context.body_of_link[&link] = index;
  context.world.bodies.push_back(body);
  return index;
}

// Links of a model collide with each other only if <self_collide> is set on the model or on one of the two links.
void forbid_self_collision(LoadContext& context, const sdf::Element& model, const std::vector<int>& bodies) {
  const bool model_collides = sdf::child_flag(&model, "self_collide", false);
  std::vector<bool> collides;
  for (const sdf::Element& link : model.children("link"))
    collides.push_back(sdf::child_flag(&link, "self_collide", model_collides));
  const auto apart = static_cast<std::size_t>(std::count(collides.begin(), collides.end(), false));
  if (context.world.no_collision.size() + apart * apart / 2 > kMaxPairs)
    context.reject(model, "has " + std::to_string(bodies.size()) +
                              " links that do not collide with each other, more than fit into memory: divide it, or set "
                              "<self_collide>");
  for (std::size_t a = 0; a < bodies.size(); ++a)
    for (std::size_t b = a + 1; b < bodies.size(); ++b)
      if (!collides[a] && !collides[b]) context.world.no_collision.emplace_back(bodies[a], bodies[b]);
}

bool is_empty(const sdf::Element& model) { return !model.child("link") && !model.child("model"); }

}  // namespace

void add_model(LoadContext& context, const sdf::Element& model, const Eigen::Isometry3d& world_pose,
               const std::string& scope, bool inside_static, int inherited) {
  const Eigen::Isometry3d pose = world_pose * context.resolve(model);
  const std::string inner = scope + std::string(model.value("name")) + "::";
  const bool is_static = sdf::child_flag(&model, "static", false) || inside_static;
  const int material = surface_material(context, &model, inherited);
  if (is_empty(model)) context.warn(model, "has no link and no effect");
  std::vector<int> bodies;
  for (const sdf::Element& link : model.children("link"))
    bodies.push_back(add_link(context, link, pose, inner, is_static, material));
  if (!is_static) forbid_self_collision(context, model, bodies);
  for (const sdf::Element& nested : model.children("model"))
    add_model(context, nested, pose, inner, is_static, material);
  for (const sdf::Element& joint : model.children("joint")) add_joint(context, joint, pose, inner);
}

}  // namespace tactus::sim
