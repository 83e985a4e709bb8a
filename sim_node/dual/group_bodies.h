// The data of a world that grouping and the two groups require: bounding radii, group bodies and settings. Pure.
#pragma once

#include <vector>

#include "sim_node/behaviour/impulse/world.h"
#include "sim_node/collision/detectors/mesh_trees.h"
#include "sim_node/dual/grouping.h"
#include "sim_node/model/world_def.h"
#include "sim_node/settings.gen.h"

namespace tactus::sim {

// Radius in m of the bounding sphere of each body about its centre of mass; 0: the body is static or has no shape.
std::vector<double> body_radii(const WorldDef& world, MeshTrees& trees);

// world: an impulse world, for its systems of joints.
std::vector<GroupBody> group_bodies(const WorldDef& def, const impulse::World& world, MeshTrees& trees);

// Settings with the behaviour model of each group: penalty contact for the haptic group, implicit (evaluated at the
// end of the step) unless the settings choose the explicit form; impulses for the visual group.
Settings for_haptic_group(Settings settings);
Settings for_visual_group(Settings settings);

}  // namespace tactus::sim
