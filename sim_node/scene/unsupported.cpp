#include "sim_node/scene/unsupported.h"

#include <cmath>
#include <functional>
#include <set>

#include "sim_node/scene/extensions/tactus_settings.h"
#include "sim_node/scene/sdf/values.h"

namespace tactus::sim {
namespace {

using Names = std::set<std::string, std::less<>>;

// Supported elements and their supported children. A child without its own entry is a leaf.
const std::map<std::string, Names, std::less<>> kSupported{
    {"sdf", {"world", "model"}},
    {"world", {"gravity", "physics", "scene", "gui", "light", "model", "joint", "frame", "tactus:material", "tactus:tool",
               "tactus:camera", "tactus:listener", "tactus:profile", "tactus:hole", "tactus:look", "tactus:shader",
               "tactus:pass", "tactus:environment", "tactus:map"}},
    {"physics", {"max_step_size", "real_time_factor", "real_time_update_rate"}},
    {"scene", {"ambient", "background"}},
    {"gui", {"camera"}},
    {"gui/camera", {"pose"}},
    {"light", {"pose", "diffuse", "specular", "attenuation", "direction", "spot", "intensity", "cast_shadows"}},
    {"model", {"pose", "static", "self_collide", "allow_auto_disable", "link", "joint", "model", "frame",
               "tactus:surface"}},
    {"frame", {"pose"}},
    {"link", {"pose", "inertial", "collision", "visual", "light", "velocity_decay", "gravity", "self_collide",
              "tactus:surface", "tactus:velocity", "tactus:spin"}},
    {"inertial", {"pose", "mass", "inertia", "density"}},
    {"collision", {"pose", "geometry", "density", "surface", "tactus:surface"}},
    {"surface", {"bounce", "friction"}},
    {"bounce", {"restitution_coefficient"}},
    {"friction", {"ode"}},
    {"friction/ode", {"mu"}},
    {"visual", {"pose", "geometry", "material", "transparency", "tactus:look", "tactus:display"}},
    {"material", {"ambient", "diffuse", "specular", "emissive", "script", "shininess", "pbr"}},
    {"pbr", {"metal", "specular"}},
    {"metal", {"albedo_map", "normal_map"}},
    {"pbr/specular", {"albedo_map", "normal_map"}},
    {"geometry", {"empty", "box", "sphere", "cylinder", "capsule", "plane", "mesh", "heightmap"}},
    {"mesh", {"uri", "scale", "submesh"}},
    {"heightmap", {"uri", "size", "pos"}},
    {"joint", {"parent", "child", "pose", "axis", "axis2", "tactus:motor"}},
    {"axis", {"xyz", "limit", "dynamics"}},
    {"axis2", {"xyz", "limit", "dynamics"}},
    {"limit", {"lower", "upper", "effort"}},
    {"dynamics", {"damping", "friction", "spring_reference", "spring_stiffness"}},
};
// Values that have no effect because they match the fixed behaviour.
const std::map<std::string, Names, std::less<>> kHarmless{
    {"enable_wind", {"false", "0"}}, {"kinematic", {"false", "0"}}, {"must_be_base_link", {"false", "0"}},
    {"visualize", {"false", "0"}},   {"light_on", {"true", "1"}},   {"laser_retro", {"0"}},
    {"lighting", {"true", "1"}},     {"double_sided", {"false", "0"}}};

// Supported elements of which an element may have several, beside those of Tactus.
const Names kSeveral{"world", "model", "link", "joint", "frame", "light", "collision", "visual", "physics"};

bool may_repeat(std::string_view name) { return kSeveral.contains(name) || name.starts_with("tactus:"); }

// Fixed step and rate of the simulation: one step per haptic tick.
constexpr double kStep_s = 0.001, kRate_Hz = 1000;

// The shapes of a geometry: it has one.
const Names kShapesOfGeometry{"empty", "box", "sphere", "cylinder", "capsule", "plane", "mesh", "heightmap"};

const Names* children_of(std::string_view parent, std::string_view name) {
  auto entry = kSupported.find(std::string(parent) + "/" + std::string(name));
  if (entry == kSupported.end()) entry = kSupported.find(name);
  return entry == kSupported.end() ? nullptr : &entry->second;
}

bool harmless(const sdf::Element& element) {
  const auto entry = kHarmless.find(element.name);
  return entry != kHarmless.end() && entry->second.contains(element.text);
}

void check_pace(const LoadContext& context, const sdf::Element& e) {
  const auto warn = [&](const char* what) { context.warn(e, "= " + std::string(e.text) + " has no effect: " + what); };
  if (e.name == "max_step_size" && std::abs(sdf::number(e) - kStep_s) > 1e-9) warn("the world is stepped by 0.001 s");
  if (e.name == "real_time_factor" && std::abs(sdf::number(e) - 1) > 1e-9) warn("the world runs in real time");
  if (e.name == "real_time_update_rate" && sdf::number(e) != 0 && std::abs(sdf::number(e) - kRate_Hz) > 1e-9)
    warn("the world is stepped 1000 times a second");
}

void walk(const LoadContext& context, const sdf::Element& element, const Names& supported) {
  Names seen;
  int shapes = 0;
  for (const sdf::Element& child : element.children()) {
    if (&child == context.camera_sensor) continue;
    if (element.name == "world" && is_setting_element(child.name)) continue;  // handled by tactus_settings.h
    if (!supported.contains(child.name)) {
      if (!harmless(child)) context.warn(child, "is not supported and has no effect");
      continue;
    }
    if (element.name == "geometry" && kShapesOfGeometry.contains(child.name)) {
      if (++shapes == 2) context.warn(element, "has several shapes, of which one counts: give each a <" + std::string(element.parent->name) + "> of its own");
    } else if (!may_repeat(child.name) && !seen.emplace(child.name).second)
      context.warn(child, "is a second <" + std::string(child.name) + "> and has no effect");
    if (element.name == "physics") check_pace(context, child);
    if (const Names* next = children_of(element.name, child.name)) walk(context, child, *next);
  }
}

}  // namespace

void warn_unsupported(const LoadContext& context, const sdf::Element& root) {
  walk(context, root, kSupported.find("sdf")->second);
}

}  // namespace tactus::sim
