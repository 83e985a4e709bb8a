// The law of an impulse world that the settings of a scene ask for.
#pragma once

#include "sim_node/behaviour/impulse/world.h"
#include "sim_node/settings.gen.h"

namespace tactus::sim {

// The settings name a model that is solved by impulses.
impulse::Law law_of(const Settings& settings);

}  // namespace tactus::sim
