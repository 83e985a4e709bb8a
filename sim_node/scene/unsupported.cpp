#include "sim_node/scene/unsupported.h"

#include <cmath>
#include <set>

#include "sim_node/scene/extensions/tactus_settings.h"

namespace tactus::sim {
namespace {

using Names = std::set<std::string>;

// Supported elements and their supported children. A child without its own entry is a leaf.
const std::map<std::string, Names> kSupported{
    {"sdf", {"world", "model"}},
    {"world", {"gravity", "physics", "scene", "gui", "light", "model", "frame", "tactus:material", "tactus:tool",
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
    {"inertial", {"pose", "mass", "inertia"}},
    {"collision", {"pose", "geometry", "surface", "tactus:surface"}},
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
const std::map<std::string, Names> kHarmless{
    {"enable_wind", {"false", "0"}}, {"kinematic", {"false", "0"}}, {"must_be_base_link", {"false", "0"}},
    {"visualize", {"false", "0"}},   {"light_on", {"true", "1"}},   {"laser_retro", {"0"}},
    {"lighting", {"true", "1"}},     {"double_sided", {"false", "0"}}};

// Fixed step and rate of the simulation: one step per haptic tick.
constexpr double kStep_s = 0.001, kRate_Hz = 1000;

const Names* children_of(const std::string& parent, const std::string& name) {
  auto entry = kSupported.find(parent + "/" + name);
  if (entry == kSupported.end()) entry = kSupported.find(name);
  return entry == kSupported.end() ? nullptr : &entry->second;
}

bool harmless(const sdf::Element& element) {
  const auto entry = kHarmless.find(element.GetName());
  return entry != kHarmless.end() && element.GetValue() && entry->second.contains(element.GetValue()->GetAsString());
}

void check_pace(const LoadContext& context, const sdf::Element& e) {
  const auto value = [&] { return e.Get<double>(); };
  if (e.GetName() == "max_step_size" && std::abs(value() - kStep_s) > 1e-9)
    context.warn(e, "= " + e.GetValue()->GetAsString() + " has no effect: the world is stepped by 0.001 s");
  if (e.GetName() == "real_time_factor" && std::abs(value() - 1) > 1e-9)
    context.warn(e, "= " + e.GetValue()->GetAsString() + " has no effect: the world runs in real time");
  if (e.GetName() == "real_time_update_rate" && value() != 0 && std::abs(value() - kRate_Hz) > 1e-9)
    context.warn(e, "= " + e.GetValue()->GetAsString() + " has no effect: the world is stepped 1000 times a second");
}

void walk(const LoadContext& context, const sdf::ElementPtr& element, const Names& supported) {
  for (auto child = element->GetFirstElement(); child; child = child->GetNextElement()) {
    if (!child->GetExplicitlySetInFile() || child == context.camera_sensor) continue;
    const std::string& name = child->GetName();
    if (element->GetName() == "world" && is_setting_element(name)) continue;  // handled by tactus_settings.h
    if (!supported.contains(name)) {
      if (!harmless(*child)) context.warn(*child, "is not supported and has no effect");
      continue;
    }
    if (element->GetName() == "physics") check_pace(context, *child);
    if (const Names* next = children_of(element->GetName(), name)) walk(context, child, *next);
  }
}

}  // namespace

void warn_unsupported(const LoadContext& context, const sdf::ElementPtr& root) {
  walk(context, root, kSupported.at("sdf"));
}

}  // namespace tactus::sim
