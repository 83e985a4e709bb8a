#include "visual_node/scene_view/lighting.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tactus/light_def_t.hpp>

#include "lcmtypes/vectors.h"

namespace tactus::visual {
namespace {

Eigen::Vector4f with(const Eigen::Vector3d& v, float w) {
  const Eigen::Vector3f f = v.cast<float>();
  return {f.x(), f.y(), f.z(), w};
}

// A shadow map covers the cone with a flat picture: beyond 160 degrees most texels would lie in its corners.
constexpr double kMaxShadowCone_rad = 160 * std::numbers::pi / 180;
// Range of a shadow: farther away a texel is coarser than the shaded detail.
constexpr double kMaxShadowDistance_m = 30;
// Ratio of far to near plane; depth precision decreases with it.
constexpr double kShadowFarToNear = 500;
// A target nearer to the lamp than this gives no direction.
constexpr double kMinAimDistance_m = 0.01;

Eigen::Matrix4f shadow_clip(const light_def_t& lamp) {
  const double far_m = std::min<double>(std::max(lamp.range_m, 0.1f), kMaxShadowDistance_m);
  const double cone = std::clamp<double>(lamp.outer_angle_rad * 1.02, 0.05, kMaxShadowCone_rad);
  return perspective(cone, 1, far_m / kShadowFarToNear, far_m) *
         look_along(to_eigen(lamp.pose.position_m), to_eigen(lamp.direction));
}

light_def_t about(light_def_t lamp, const Eigen::Vector3d& origin_m) {
  lamp.pose.position_m = to_vec3(to_eigen(lamp.pose.position_m) - origin_m);
  return lamp;
}

}  // namespace

Light make_light(const light_def_t& lamp) {
  const bool directional = lamp.kind == light_def_t::DIRECTIONAL, spot = lamp.kind == light_def_t::SPOT;
  Light l;
  l.position = with(to_eigen(lamp.pose.position_m), directional ? 0 : 1);
  l.direction = with(to_eigen(lamp.direction).normalized(), 0);
  l.diffuse = with(to_eigen(lamp.diffuse) * lamp.intensity, directional ? 1e30f : lamp.range_m);
  l.specular = with(to_eigen(lamp.specular) * lamp.intensity, 0);
  if (!directional)
    l.attenuation = {lamp.attenuation_constant, lamp.attenuation_linear, lamp.attenuation_quadratic, 0};
  if (spot) {
    const float outer = std::cos(lamp.outer_angle_rad / 2);
    // An inner cone as wide as the outer one has a hard edge: 0.001 of cosine is half a texel of the shadow
    // map.
    const float factor = 1 / std::max(std::cos(lamp.inner_angle_rad / 2) - outer, 1e-3f);
    l.cone = {factor, -outer * factor, lamp.falloff > 0 ? lamp.falloff : 1, 0};
  }
  return l;
}

void set_origin(Lighting& lighting, std::span<const light_def_t> lamps, const Eigen::Vector3d& origin_m) {
  for (std::size_t i = 0; i < std::min(lighting.lights.size(), lamps.size()); ++i) {
    const light_def_t lamp = about(lamps[i], origin_m);
    lighting.lights[i].position.head<3>() = to_eigen(lamp.pose.position_m).cast<float>();
    if (lighting.shadow_light == static_cast<int>(i)) lighting.shadow_clip = shadow_clip(lamp);
  }
}

void aim(Lighting& lighting, std::size_t light, const light_def_t& lamp, const Eigen::Vector3d& at, const Eigen::Vector3d& origin_m) {
  const Eigen::Vector3d to = at - to_eigen(lamp.pose.position_m);
  if (light >= lighting.lights.size() || !(to.norm() > kMinAimDistance_m)) return;
  light_def_t aimed = about(lamp, origin_m);
  aimed.direction = to_vec3(to.normalized());
  lighting.lights[light] = make_light(aimed);
  if (lighting.shadow_light == static_cast<int>(light)) lighting.shadow_clip = shadow_clip(aimed);
}

Lighting make_lighting(const scene_t& scene, const Settings& settings) {
  Lighting lighting;
  for (const light_def_t& lamp : scene.lights) {
    if (lighting.lights.size() == kMaxLights) break;
    lighting.lights.push_back(make_light(lamp));
    if (!settings.shadows || lighting.shadow_light >= 0 || lamp.kind != light_def_t::SPOT || !lamp.casts_shadow)
      continue;
    lighting.shadow_light = static_cast<int>(lighting.lights.size()) - 1;
    lighting.shadow_clip = shadow_clip(lamp);
  }
  lighting.ambient = static_cast<float>(settings.ambient) * to_eigen(scene.ambient).cast<float>();
  lighting.background = to_eigen(scene.background).cast<float>();
  lighting.exposure = static_cast<float>(settings.exposure);
  return lighting;
}

}  // namespace tactus::visual
