// The contact law of an impulse world, from the settings of a scene.
#pragma once

#include "sim_node/behaviour/impulse/world.h"
#include "sim_node/settings.gen.h"

namespace tactus::sim {

// The settings must name a model that is solved by impulses.
impulse::ContactLaw contact_law(const Settings& settings);

}  // namespace tactus::sim
