// The degradation profile of a scene: <tactus:profile> with its <tactus:degrade> rules, or the name of a file.
#pragma once

#include "sim_node/scene/sdf/load_context.h"

namespace tactus::sim {

// Fills WorldDef::profile with its XML in the syntax of sync/degradation. Errors name the line.
void read_profile(LoadContext& context, const sdf::Element& world);

}  // namespace tactus::sim
