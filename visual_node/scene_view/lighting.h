// The lamps of a scene as the shaders want them.
#pragma once

#include <tactus/light_def_t.hpp>
#include <tactus/scene_t.hpp>

#include "visual_node/scene_view/draw_list.h"
#include "visual_node/settings.gen.h"

namespace tactus::visual {

// Angles in a light_def_t are full angles of the cone.
Light make_light(const light_def_t& lamp);

// The first kMaxLights lamps; the first spot that casts shadows gets the shadow map, unless `shadows` is false.
Lighting make_lighting(const scene_t& scene, const Settings& settings);

// Turns a spot, with its shadow, so that it shines at a place. lamp: as the scene has it.
void aim(Lighting& lighting, std::size_t light, const light_def_t& lamp, const Eigen::Vector3d& at);

}  // namespace tactus::visual
