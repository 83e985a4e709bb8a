// <tactus:map from="haptic_node.speed" to="visual_node.exposure" gain="2"/>: a tagged variable that drives a setting.
#pragma once

#include "sim_node/scene/sdf/load_context.h"

namespace tactus::sim {

// Rejects a setting that the node does not have, that is not a number or that cannot be changed at run time. Checks
// only the form of the variable, because its process defines the variables at run time.
void read_maps(LoadContext& context, const sdf::Element& world);

}  // namespace tactus::sim
