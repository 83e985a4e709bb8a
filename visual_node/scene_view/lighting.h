// Converts the lamps of a scene for the shaders.
#pragma once

#include <span>
#include <tactus/light_def_t.hpp>
#include <tactus/scene_t.hpp>

#include "visual_node/scene_view/draw_list.h"
#include "visual_node/settings.gen.h"

namespace tactus::visual {

// Angles in a light_def_t are full angles of the cone.
Light make_light(const light_def_t& lamp);

// The first kMaxLights lamps; the first spot that casts shadows gets the shadow map, unless settings.shadows is
// off.
// About the origin of the world.
Lighting make_lighting(const scene_t& scene, const Settings& settings);

// The same lamps about another origin, m, world. lamps: those of the scene, in its order.
void set_origin(Lighting& lighting, std::span<const light_def_t> lamps, const Eigen::Vector3d& origin_m);

// Turns a spot light and its shadow towards the point `at`, m, world. lamp: its definition in the scene. origin_m: of the lighting.
void aim(Lighting& lighting, std::size_t light, const light_def_t& lamp, const Eigen::Vector3d& at,
         const Eigen::Vector3d& origin_m = Eigen::Vector3d::Zero());

}  // namespace tactus::visual
