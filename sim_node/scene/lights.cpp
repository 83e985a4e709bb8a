#include "sim_node/scene/lights.h"

#include <algorithm>
#include <tactus/light_def_t.hpp>
#include <tactus/vec3f_t.hpp>

#include "lcmtypes/vectors.h"
#include "sim_node/scene/sdf/values.h"

namespace tactus::sim {
namespace {

// SDF's defaults (light.sdf).
constexpr double kDefaultRange_m = 10;
const sdf::Colour kDefaultDiffuse{{1, 1, 1}, 1}, kDefaultSpecular{Eigen::Vector3f(.1f, .1f, .1f).cast<double>(), 1};

std::int8_t kind_of(const sdf::Element& light) {
  const std::string_view type = light.value("type", "point");
  if (type == "point") return light_def_t::POINT;
  if (type == "spot") return light_def_t::SPOT;
  if (type == "directional") return light_def_t::DIRECTIONAL;
  sdf::reject(light, "has type \"" + std::string(type) + "\": there are point, spot and directional");
}

// At least 0; large numbers are cut.
float number_in(const sdf::Element* owner, const char* name, double missing) {
  const sdf::Element* given = sdf::child_of(owner, name);
  const double value = given ? sdf::number_or_infinity(*given) : missing;
  if (!(value >= 0)) sdf::reject(*given, "= " + std::string(given->text) + " must be 0 or more");
  return static_cast<float>(std::min(value, 1e6));
}

// The direction of a spot or directional light in its own frame; a point light has none.
Eigen::Vector3d direction_of(const sdf::Element& light, bool has_direction) {
  const Eigen::Vector3d down(0, 0, -1);
  return has_direction ? sdf::child_vector3(&light, "direction", down) : down;
}

}  // namespace

void add_light(LoadContext& context, const sdf::Element& light, const Eigen::Isometry3d& parent_pose) {
  const Eigen::Isometry3d pose = parent_pose * context.resolve(light);
  light_def_t def{};
  def.name = light.value("name");
  def.kind = kind_of(light);
  const Eigen::Vector3d direction = pose.linear() * direction_of(light, def.kind != light_def_t::POINT);
  if (!direction.allFinite() || direction.norm() < 1e-9) context.reject(light, "has no <direction>");
  def.pose = to_pose(pose);
  def.direction = to_vec3(direction.normalized());
  def.diffuse = to_vec3f(sdf::child_colour(&light, "diffuse").value_or(kDefaultDiffuse).rgb);
  def.specular = to_vec3f(sdf::child_colour(&light, "specular").value_or(kDefaultSpecular).rgb);
  const sdf::Element* attenuation = light.child("attenuation");
  def.range_m = number_in(attenuation, "range", kDefaultRange_m);
  def.attenuation_constant = number_in(attenuation, "constant", 1);
  def.attenuation_linear = number_in(attenuation, "linear", 1);
  def.attenuation_quadratic = number_in(attenuation, "quadratic", 0);
  def.intensity = number_in(&light, "intensity", 1);
  const sdf::Element* spot = def.kind == light_def_t::SPOT ? light.child("spot") : nullptr;
  def.inner_angle_rad = number_in(spot, "inner_angle", 0);
  def.outer_angle_rad = number_in(spot, "outer_angle", 0);
  def.falloff = number_in(spot, "falloff", 0);
  def.casts_shadow = sdf::child_flag(&light, "cast_shadows", false) ? 1 : 0;
  context.world.lights.push_back(def);
}

light_def_t sun() {
  light_def_t def{};
  def.name = "sun";
  def.kind = light_def_t::DIRECTIONAL;
  def.pose = to_pose(Eigen::Isometry3d(Eigen::Translation3d(0, 0, 10)));
  def.direction = to_vec3(Eigen::Vector3d(-0.5, 0.1, -0.9).normalized());
  def.diffuse = to_vec3f({0.8, 0.8, 0.8});
  def.specular = to_vec3f({0.2, 0.2, 0.2});
  def.range_m = 1000;
  def.attenuation_constant = 1;
  def.intensity = 1;
  def.casts_shadow = 1;
  return def;
}

}  // namespace tactus::sim
