// <tactus:tool>: handheld tools of a scene, and the paths of virtual hands.
#pragma once

#include "sim_node/scene/sdf/load_context.h"

namespace tactus::sim {

// Appends a tool and its body for every <tactus:tool> of the world, after all other bodies.
void read_tools(LoadContext& context, const sdf::Element& world);

}  // namespace tactus::sim
