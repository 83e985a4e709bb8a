#include "sim_node/scene/tactus_tools.h"

#include <cmath>
#include <span>
#include <tactus/tool_def_t.hpp>
#include <tactus/waypoint_t.hpp>

#include "lcmtypes/tool_device.h"
#include "lcmtypes/vectors.h"
#include "sim_node/scene/sdf/attributes.h"
#include "sim_node/scene/mass.h"
#include "sim_node/scene/meshes.h"
#include "sim_node/model/tool_shape.h"
#include "sync/sandbox/regular_file.h"

namespace tactus::sim {
namespace {

// Defaults: a fingertip, and an effective mass of the hand at the fingertip of about 0.1 kg (design).
constexpr double kDefaultRadius_m = 0.008, kDefaultMass_kg = 0.1;

waypoint_t read_waypoint(const LoadContext& context, const sdf::Element& element) {
  Attributes attributes(context, element);
  waypoint_t waypoint{};
  waypoint.time_s = attributes.required_quantity("time", "s", 0, 1e6);
  attributes.required_text("position");
  waypoint.position_m = to_vec3(*attributes.position("position"));
  attributes.done();
  return waypoint;
}

// The device string as published to the hand, with the full path of its motion file, which is located like a mesh
// file.
std::string read_device(const LoadContext& context, const sdf::Element& element, const std::string& text) try {
  const ToolDevice device = parse_tool_device(text);
  if (device.file.empty()) return text;
  const std::filesystem::path file = context.asset_file(device.file, element);
  try {
    sync::check_regular_file(file, kMaxMotionFileBytes);
  } catch (const std::runtime_error& e) {
    context.reject(element, "names \"" + device.file + "\", which cannot be read: " + e.what());
  }
  return with_device_file(text, std::filesystem::absolute(file).lexically_normal().string());
} catch (const BadDevice& e) {
  context.reject(element, std::string("has a bad device: ") + e.what());
}

constexpr double kMaxSize_m = 1, kMinSize_m = 1e-4;  // of a handheld tool

// The triangles of a mesh tool; each file and scale is read once.
int mesh_of_tool(LoadContext& context, const sdf::Element& element, const std::string& uri, double scale) {
  const std::filesystem::path file = context.asset_file(uri, element);
  const std::string key = file.string() + "|tool|" + std::to_string(scale);
  const auto [at, is_new] = context.mesh_of.try_emplace(key, static_cast<int>(context.world.meshes.size()));
  if (is_new) try {
      add_mesh(context, join_parts(mesh_parts(context, file), {"", false, Eigen::Vector3d::Constant(scale)}));
    } catch (const std::exception& e) {
      context.reject(element, "names mesh \"" + uri + "\", which cannot be read: " + e.what());
    }
  return at->second;
}

// The touching geometry: a ball, or a shape with torque feedback.
void read_tool_shape(LoadContext& context, const sdf::Element& element, Attributes& attributes, tool_def_t& tool) {
  const std::string shape = attributes.text("shape").value_or("ball");
  tool.shape = tool_def_t::BALL;
  if (shape == "ball") {
    tool.radius_m = attributes.quantity("radius", "m", 0, 1).value_or(kDefaultRadius_m);
  } else if (shape == "box") {
    tool.shape = tool_def_t::BOX;
    const auto edges = attributes.required_quantities("size", 3, "m", kMinSize_m, kMaxSize_m);
    tool.size_m = {edges[0], edges[1], edges[2]};
  } else if (shape == "capsule") {
    tool.shape = tool_def_t::CAPSULE;
    tool.size_m.x = attributes.required_quantity("radius", "m", kMinSize_m, kMaxSize_m);
    tool.size_m.z = attributes.required_quantity("length", "m", kMinSize_m, kMaxSize_m);
  } else if (shape == "mesh") {
    tool.shape = tool_def_t::MESH;
    const std::string uri = attributes.required_text("mesh");
    tool.mesh_hash = mesh_of_tool(context, element, uri, attributes.quantity("scale", "1", 1e-6, 1e6).value_or(1));
  } else {
    context.reject(element, "has shape \"" + shape + "\": give it ball, box, capsule or mesh");
  }
}

// A solid of uniform density; a point counts as a ball of 1 mm.
Eigen::Matrix3d tool_inertia(const WorldDef& world, const tool_def_t& tool, Eigen::Vector3d& centre_m, std::vector<MassRemark>& remarks) {
  ShapeDef shape = tool_shape(tool);
  shape.material = -1;
  if (shape.kind == ShapeKind::kSphere) return 0.4 * tool.mass_kg * std::pow(std::max(tool.radius_m, 1e-3), 2) * Eigen::Matrix3d::Identity();
  bool has_density = false;
  const MassProperties mass = scaled_to(mass_of(world, std::span(&shape, 1), has_density, &remarks), tool.mass_kg);
  centre_m = mass.centre_of_mass_m;
  return mass.inertia_kg_m2;
}

void read_tool(LoadContext& context, const sdf::Element& element) {
  Attributes attributes(context, element);
  tool_def_t tool{};
  tool.name = attributes.required_text("name");
  if (context.body_of.contains(tool.name))
    context.reject(element, "has a name that is already in use: choose another");
  read_tool_shape(context, element, attributes, tool);
  tool.mass_kg = attributes.quantity("mass", "kg", 1e-4, 100).value_or(kDefaultMass_kg);
  tool.device = read_device(context, element, attributes.text("device").value_or("virtual_hand"));
  tool.loop = attributes.flag("loop").value_or(false) ? 1 : 0;
  tool.material = -1;
  if (const auto material = attributes.text("material")) {
    const auto known = context.material_of.find(*material);
    if (known == context.material_of.end())
      context.reject(element, "names material \"" + *material + "\": there is none");
    tool.material = known->second;
  }
  const auto pose = attributes.pose("pose");
  attributes.done();

  for (const sdf::Element& child : element.children()) {
    if (child.name != "tactus:waypoint") {
      context.warn(child, "is not supported and has no effect");
      continue;
    }
    const waypoint_t waypoint = read_waypoint(context, child);
    if (!tool.waypoints.empty() && !(waypoint.time_s > tool.waypoints.back().time_s))
      context.reject(child, "comes at or before the waypoint above it: times must increase");
    tool.waypoints.push_back(waypoint);
  }
  tool.waypoint_count = static_cast<std::int32_t>(tool.waypoints.size());
  if (tool.waypoints.empty() && tool.device == "virtual_hand")
    context.reject(element, "has no <tactus:waypoint>: the virtual hand needs a path of one or more");

  BodyDef body;
  body.name = tool.name;
  body.tool = static_cast<int>(context.world.tools.size());
  body.mass_kg = tool.mass_kg;
  body.gravity = false;
  if (pose) body.pose = *pose;
  if (!pose && !tool.waypoints.empty()) body.pose.translation() = to_eigen(tool.waypoints.front().position_m);
  tool.body = static_cast<std::int32_t>(context.world.bodies.size());
  context.body_of[body.name] = tool.body;
  context.world.bodies.push_back(body);
  if (is_shaped(tool)) tool.radius_m = bound_m(context.world, tool_shape(tool));
  if (tool.radius_m > kMaxSize_m)
    context.reject(element, "extends further than 1 m from its origin: make it smaller");
  BodyDef& held = context.world.bodies.back();
  std::vector<MassRemark> remarks;
  held.inertia_kg_m2 = tool_inertia(context.world, tool, held.centre_of_mass_m, remarks);
  for (const MassRemark& r : remarks)
    context.warn(element, "has a mesh that " + r.clause + " for the inertia; close the mesh");
  context.world.tools.push_back(tool);
}

}  // namespace

void read_tools(LoadContext& context, const sdf::Element& world) {
  for (const sdf::Element& element : world.children("tactus:tool")) read_tool(context, element);
}

}  // namespace tactus::sim
