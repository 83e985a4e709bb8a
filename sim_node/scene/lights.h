// Lamps.
#pragma once

#include <sdf/Light.hh>
#include <tactus/light_def_t.hpp>

#include "sim_node/scene/sdf/load_context.h"

namespace tactus::sim {

// Appends a lamp; `parent_pose` is the pose in the world of the world or link that it stands in.
void add_light(LoadContext& context, const sdf::Light& light, const Eigen::Isometry3d& parent_pose);

// The sun that Gazebo brings, for a scene that includes it or has no lamp at all.
light_def_t sun();

}  // namespace tactus::sim
