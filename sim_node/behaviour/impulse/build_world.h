// The bodies and joints of a scene as the impulse solver takes them: what hangs on nothing flies freely, what
// joints hold together is a system in joint coordinates.
#pragma once

#include <memory>

#include "sim_node/behaviour/impulse/world.h"
#include "sim_node/model/world_def.h"
#include "sim_node/settings.gen.h"

namespace tactus::sim::impulse {

// Numbers of bodies and shapes are those of the scene; tools and what is static do not move. Throws
// std::runtime_error with one sentence when joints close a loop, or a mass or inertia is not positive.
std::unique_ptr<World> build_world(const WorldDef& def, const Settings& settings);

}  // namespace tactus::sim::impulse
