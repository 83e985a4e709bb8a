// <tactus:map from="haptic_node.speed" to="visual_node.exposure" gain="2"/>: a tagged variable that drives a setting.
#pragma once

#include "sim_node/scene/sdf/load_context.h"

namespace tactus::sim {

// Refuses a setting that its node does not have, that is no number or that cannot be changed while the node runs. Of a
// variable only the form is checked: which there are is known when its process runs.
void read_maps(LoadContext& context, const sdf::ElementPtr& world);

}  // namespace tactus::sim
