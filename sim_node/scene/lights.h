// Lights of a scene.
#pragma once

#include <tactus/light_def_t.hpp>

#include "sim_node/scene/sdf/load_context.h"

namespace tactus::sim {

// Appends a light; `parent_pose`: pose of the containing world or link in the world.
void add_light(LoadContext& context, const sdf::Element& light, const Eigen::Isometry3d& parent_pose);

// The sun of Gazebo, for a scene that includes it or has no light.
light_def_t sun();

}  // namespace tactus::sim
