// Converts the lamps of a scene for the shaders.
#pragma once

#include <tactus/light_def_t.hpp>
#include <tactus/scene_t.hpp>

#include "visual_node/scene_view/draw_list.h"
#include "visual_node/settings.gen.h"

namespace tactus::visual {

// Angles in a light_def_t are full angles of the cone.
Light make_light(const light_def_t& lamp);

// The first kMaxLights lamps; the first spot that casts shadows gets the shadow map, unless settings.shadows is
// off.
Lighting make_lighting(const scene_t& scene, const Settings& settings);

// Turns a spot light and its shadow towards the point `at`, m, world. lamp: its definition in the scene.
void aim(Lighting& lighting, std::size_t light, const light_def_t& lamp, const Eigen::Vector3d& at);

}  // namespace tactus::visual
