#include "sim_node/scene/lights.h"

#include <tactus/light_def_t.hpp>
#include <tactus/vec3f_t.hpp>

#include "lcmtypes/vectors.h"
#include "sim_node/scene/sdf/sdf_eigen.h"

namespace tactus::sim {
namespace {

double at_least_0(const LoadContext& context, const sdf::Element& element, double value, const char* what) {
  if (!(value >= 0)) context.reject(element, std::string("has a ") + what + " that is negative or not a number");
  return std::min(value, 1e6);
}

vec3f_t light_colour(const LoadContext& context, const sdf::Element& element, const ignition::math::Color& c) {
  const Eigen::Vector3d rgb = to_eigen(c);
  if (!rgb.allFinite()) context.reject(element, "has a colour that is not finite");
  return to_vec3f(rgb.cwiseMax(0).cwiseMin(1e3));
}

}  // namespace

void add_light(LoadContext& context, const sdf::Light& light, const Eigen::Isometry3d& parent_pose) {
  const sdf::Element& e = *light.Element();
  const Eigen::Isometry3d pose = parent_pose * context.resolve(light.SemanticPose(), e);
  const Eigen::Vector3d direction = pose.linear() * to_eigen(light.Direction());
  if (!direction.allFinite() || direction.norm() < 1e-9) context.reject(e, "has no <direction>");
  light_def_t def{};
  def.name = light.Name();
  def.kind = light.Type() == sdf::LightType::SPOT          ? light_def_t::SPOT
             : light.Type() == sdf::LightType::DIRECTIONAL ? light_def_t::DIRECTIONAL
                                                           : light_def_t::POINT;
  def.pose = to_pose(pose);
  def.direction = to_vec3(direction.normalized());
  def.diffuse = light_colour(context, e, light.Diffuse());
  def.specular = light_colour(context, e, light.Specular());
  const auto number = [&](double value, const char* what) {
    return static_cast<float>(at_least_0(context, e, value, what));
  };
  def.range_m = number(light.AttenuationRange(), "range");
  def.attenuation_constant = number(light.ConstantAttenuationFactor(), "constant attenuation");
  def.attenuation_linear = number(light.LinearAttenuationFactor(), "linear attenuation");
  def.attenuation_quadratic = number(light.QuadraticAttenuationFactor(), "quadratic attenuation");
  def.intensity = number(light.Intensity(), "intensity");
  def.inner_angle_rad = number(light.SpotInnerAngle().Radian(), "inner angle");
  def.outer_angle_rad = number(light.SpotOuterAngle().Radian(), "outer angle");
  def.falloff = number(light.SpotFalloff(), "falloff");
  def.casts_shadow = light.CastShadows() ? 1 : 0;
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
