#include "sim_node/scene/visuals.h"

#include <algorithm>
#include <sdf/Material.hh>

#include "sim_node/scene/sdf_eigen.h"

namespace tactus::sim {
namespace {

// The plain colours that Gazebo classic brings as scripts and that its worlds refer to by name; our approximations.
const std::map<std::string, Eigen::Vector3d> kScripts{
    {"Gazebo/Grey", {0.5, 0.5, 0.5}},   {"Gazebo/DarkGrey", {0.2, 0.2, 0.2}}, {"Gazebo/White", {0.9, 0.9, 0.9}},
    {"Gazebo/Black", {0.02, 0.02, 0.02}}, {"Gazebo/Red", {0.8, 0.05, 0.05}},  {"Gazebo/Green", {0.05, 0.7, 0.05}},
    {"Gazebo/Blue", {0.05, 0.05, 0.8}}, {"Gazebo/Yellow", {0.9, 0.9, 0.05}},  {"Gazebo/Orange", {1, 0.5, 0.05}},
    {"Gazebo/Purple", {0.6, 0.05, 0.6}}, {"Gazebo/Turquoise", {0.05, 0.8, 0.8}}, {"Gazebo/Gold", {0.8, 0.65, 0.1}},
    {"Gazebo/Wood", {0.5, 0.32, 0.17}}};

Eigen::Vector3d colour(const LoadContext& context, const sdf::Element& element, const ignition::math::Color& c) {
  const Eigen::Vector3d rgb = to_eigen(c);
  if (!rgb.allFinite()) context.refuse(element, "has a colour that is not finite");
  return rgb.cwiseMax(0).cwiseMin(1);
}

}  // namespace

void read_look(const LoadContext& context, const sdf::Visual& from, VisualDef& visual) {
  const sdf::ElementPtr element = from.Element();
  visual.alpha = std::clamp(1.0 - static_cast<double>(from.Transparency()), 0.0, 1.0);
  const sdf::ElementPtr material = written(element, "material");
  if (!material || !from.Material()) return;
  const sdf::Material& m = *from.Material();
  const auto given = [&](const char* name) { return written(material, name) != nullptr; };

  if (const sdf::ElementPtr script = written(material, "script")) {
    const auto known = kScripts.find(m.ScriptName());
    if (known != kScripts.end())
      visual.ambient = visual.diffuse = known->second;
    else if (!given("diffuse"))
      context.warn(*script, "names \"" + m.ScriptName() + "\", whose colour is not known: shown grey");
  }
  if (given("diffuse")) visual.diffuse = visual.ambient = colour(context, *material, m.Diffuse());
  if (given("ambient")) visual.ambient = colour(context, *material, m.Ambient());
  if (given("specular")) visual.specular = colour(context, *material, m.Specular());
  if (given("emissive")) visual.emissive = colour(context, *material, m.Emissive());
  if (given("diffuse") && m.Diffuse().A() < 1) visual.alpha *= std::clamp(static_cast<double>(m.Diffuse().A()), 0.0, 1.0);
}

}  // namespace tactus::sim
