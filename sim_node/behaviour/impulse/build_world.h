// Builds the impulse world of a scene: bodies without joints become free bodies, jointed bodies become systems in
// joint coordinates.
#pragma once

#include <memory>

#include "sim_node/behaviour/impulse/world.h"
#include "sim_node/model/world_def.h"
#include "sim_node/settings.gen.h"

namespace tactus::sim::impulse {

// Indices of bodies and shapes are those of the scene. Tools and static bodies do not move. Throws std::runtime_error
// with one sentence when joints form a loop, or a mass or inertia is not positive.
std::unique_ptr<World> build_world(const WorldDef& def, const Settings& settings);

}  // namespace tactus::sim::impulse
