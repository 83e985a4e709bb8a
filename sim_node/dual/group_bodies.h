// What grouping and the two groups need to know of a world. Pure.
#pragma once

#include <vector>

#include "sim_node/behaviour/impulse/world.h"
#include "sim_node/collision/detectors/mesh_trees.h"
#include "sim_node/dual/grouping.h"
#include "sim_node/model/world_def.h"
#include "sim_node/settings.gen.h"

namespace tactus::sim {

// Radius about its centre of mass of the sphere that holds each body, m; 0: it never moves, or has no shape.
std::vector<double> body_radii(const WorldDef& world, MeshTrees& trees);

// world: of impulses, for its systems of joints.
std::vector<GroupBody> group_bodies(const WorldDef& def, const impulse::World& world, MeshTrees& trees);

// Settings with the behaviour models that the groups have: penalty contact where a hand may be, of the end of the step
// unless the settings ask for the explicit form; impulses elsewhere.
Settings for_haptic_group(Settings settings);
Settings for_visual_group(Settings settings);

}  // namespace tactus::sim
