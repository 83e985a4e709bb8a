#include "sim_node/scene/bodies.h"

#include <limits>
#include <sdf/Collision.hh>
#include <sdf/Link.hh>
#include <sdf/Sensor.hh>
#include <sstream>
#include <tactus/material_def_t.hpp>

#include "sim_node/scene/inertial.h"
#include "sim_node/scene/joints.h"
#include "sim_node/scene/lights.h"
#include "sim_node/scene/meshes.h"
#include "sim_node/scene/sdf/sdf_eigen.h"
#include "sim_node/scene/shapes.h"
#include "sim_node/scene/extensions/tactus_materials.h"
#include "sim_node/scene/visuals.h"

namespace tactus::sim {
namespace {

// SDF's default (surface.sdf): friction 1 and no restitution.
constexpr double kDefaultFriction = 1;
// Limits of initial velocities: above those of any scene that a step of 1 ms can resolve. Design values.
constexpr double kMaxSpeed_m_s = 1000, kMaxSpin_rad_s = 10000;

double value_of(const LoadContext& context, const sdf::ElementPtr& element, double min, double max) {
  const double value = element->Get<double>();
  if (!(value >= min && value <= max))
    context.reject(*element, "= " + element->GetValue()->GetAsString() + " is out of range");
  return value;
}

// Values in SDF take precedence over those of the material.
void read_surface(const LoadContext& context, const sdf::ElementPtr& collision, int inherited, ShapeDef& shape) {
  shape.material = surface_material(context, collision, inherited);
  shape.friction = kDefaultFriction;
  if (shape.material >= 0) {
    const material_def_t& material = context.world.materials[static_cast<std::size_t>(shape.material)];
    shape.friction = material.friction_dynamic, shape.restitution = material.restitution;
  }
  const sdf::ElementPtr surface = explicit_child(collision, "surface");
  if (const auto mu = explicit_child(explicit_child(explicit_child(surface, "friction"), "ode"), "mu"))
    shape.friction = std::min(value_of(context, mu, 0, std::numeric_limits<double>::infinity()), 1e6);
  if (const auto bounce = explicit_child(explicit_child(surface, "bounce"), "restitution_coefficient"))
    shape.restitution = value_of(context, bounce, 0, 1);
}

// Material that the mesh file names; -1: none.
int file_material(LoadContext& context, const sdf::Geometry& geometry, const sdf::ElementPtr& owner) {
  if (geometry.Type() != sdf::GeometryType::MESH || explicit_child(owner, "tactus:surface")) return -1;
  return material_of_file(context, named_mesh(context, *geometry.MeshShape(), *owner), -1);
}

void add_collisions(LoadContext& context, const sdf::Link& link, int body, int material) {
  for (std::uint64_t i = 0; i < link.CollisionCount(); ++i) {
    const sdf::Collision& collision = *link.CollisionByIndex(i);
    const sdf::ElementPtr element = collision.Element();
    auto shape = read_shape(context, *collision.Geom(), element, context.resolve(collision.SemanticPose(), *element));
    if (!shape) continue;
    shape->name = collision.Name();
    shape->body = body;
    read_surface(context, element, material < 0 ? file_material(context, *collision.Geom(), element) : material, *shape);
    context.world.shapes.push_back(*shape);
  }
}

// A body with visuals but no collision gets the bounding box of its visuals, and every plane among them.
void add_bounding_box(LoadContext& context, std::size_t first_visual, int body, int material) {
  ShapeDef box;
  Eigen::AlignedBox3d bounding_box;
  for (std::size_t i = first_visual; i < context.world.visuals.size(); ++i) {
    const ShapeDef& shape = context.world.visuals[i].shape;
    bounding_box.extend(bounds(context.world, shape));
    if (shape.kind == ShapeKind::kPlane) box = shape;
    if (material < 0) material = shape.material;
  }
  box.name = "bounding_box", box.body = body;
  if (!bounding_box.isEmpty()) {
    box.kind = ShapeKind::kBox;
    box.pose = Eigen::Translation3d(bounding_box.center()) * Eigen::Isometry3d::Identity();
    box.size_m = bounding_box.sizes().cwiseMax(1e-4);  // a flat mesh has no thickness
  }
  read_surface(context, nullptr, material, box);
  context.world.shapes.push_back(box);
}

void find_camera(LoadContext& context, const sdf::Link& link, const Eigen::Isometry3d& pose) {
  for (std::uint64_t i = 0; i < link.SensorCount() && !context.camera_sensor; ++i) {
    const sdf::Sensor& sensor = *link.SensorByIndex(i);
    if (sensor.Type() != sdf::SensorType::CAMERA || !sensor.CameraSensor()) continue;
    context.camera_sensor = sensor.Element();
    context.camera_sensor_pose = pose * context.resolve(sensor.SemanticPose(), *sensor.Element());
  }
}

// Three numbers of an element of a link, for example <tactus:velocity>1 0 0.5</tactus:velocity>; zero without it.
Eigen::Vector3d initial_rate(const LoadContext& context, const sdf::ElementPtr& link, const char* name, double max) {
  const sdf::ElementPtr given = explicit_child(link, name);
  if (!given) return {0, 0, 0};
  const std::string text = given->GetValue() ? given->GetValue()->GetAsString() : "";
  std::istringstream words(text);
  Eigen::Vector3d out;
  std::string more;
  if (!(words >> out.x() >> out.y() >> out.z()) || words >> more || !out.allFinite() || out.norm() > max)
    context.reject(*given, "= \"" + text + "\": it must be three numbers, of at most " +
                               std::to_string(static_cast<long>(max)) + " as a vector");
  return out;
}

int add_link(LoadContext& context, const sdf::Link& link, const Eigen::Isometry3d& model_pose, const std::string& scope,
             bool is_static, int inherited) {
  const sdf::ElementPtr element = link.Element();
  const int index = static_cast<int>(context.world.bodies.size());
  const int material = surface_material(context, element, inherited);
  BodyDef body;
  body.name = scope + link.Name();
  body.is_static = is_static;
  body.pose = model_pose * context.resolve(link.SemanticPose(), *element);
  const std::size_t first_shape = context.world.shapes.size(), first_visual = context.world.visuals.size();
  add_collisions(context, link, index, material);
  add_visuals(context, link, index, material);
  if (first_shape == context.world.shapes.size() && first_visual < context.world.visuals.size())
    add_bounding_box(context, first_visual, index, material);
  read_inertial(context, element, std::span(context.world.shapes).subspan(first_shape), body);
  if (const auto gravity = explicit_child(element, "gravity")) body.gravity = gravity->Get<bool>();
  if (const auto decay = explicit_child(element, "velocity_decay")) {
    const auto damping = [&](const char* name) {
      const auto given = explicit_child(decay, name);
      return given ? value_of(context, given, 0, 1e6) : 0.0;
    };
    body.linear_damping_1_s = damping("linear"), body.angular_damping_1_s = damping("angular");
  }
  body.velocity_m_s = initial_rate(context, element, "tactus:velocity", kMaxSpeed_m_s);
  body.spin_rad_s = initial_rate(context, element, "tactus:spin", kMaxSpin_rad_s);
  find_camera(context, link, body.pose);
  for (std::uint64_t i = 0; i < link.LightCount(); ++i) {
    if (!is_static) context.warn(*link.LightByIndex(i)->Element(), "stays where it is when its link moves");
    add_light(context, *link.LightByIndex(i), body.pose);
  }
  context.body_of[body.name] = index;
  context.world.bodies.push_back(body);
  return index;
}

// Links of a model collide with each other only if <self_collide> is set on the model or on one of the two links.
void forbid_self_collision(LoadContext& context, const sdf::Model& model, const std::vector<int>& bodies) {
  std::vector<bool> collides;
  for (std::uint64_t i = 0; i < model.LinkCount(); ++i) {
    const auto given = explicit_child(model.LinkByIndex(i)->Element(), "self_collide");
    collides.push_back(given ? given->Get<bool>() : model.SelfCollide());
  }
  for (std::size_t a = 0; a < bodies.size(); ++a)
    for (std::size_t b = a + 1; b < bodies.size(); ++b)
      if (!collides[a] && !collides[b]) context.world.no_collision.emplace_back(bodies[a], bodies[b]);
}

}  // namespace

void add_model(LoadContext& context, const sdf::Model& model, const Eigen::Isometry3d& world_pose,
               const std::string& scope, bool inside_static, int inherited) {
  const Eigen::Isometry3d pose = world_pose * context.resolve(model.SemanticPose(), *model.Element());
  const std::string inner = scope + model.Name() + "::";
  const bool is_static = inside_static || model.Static();
  const int material = surface_material(context, model.Element(), inherited);
  std::vector<int> bodies;
  for (std::uint64_t i = 0; i < model.LinkCount(); ++i)
    bodies.push_back(add_link(context, *model.LinkByIndex(i), pose, inner, is_static, material));
  if (!is_static) forbid_self_collision(context, model, bodies);
  for (std::uint64_t i = 0; i < model.ModelCount(); ++i)
    add_model(context, *model.ModelByIndex(i), pose, inner, is_static, material);
  for (std::uint64_t i = 0; i < model.JointCount(); ++i) add_joint(context, *model.JointByIndex(i), pose, inner);
}

}  // namespace tactus::sim
