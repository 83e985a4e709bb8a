// <tactus:hole>: the holes of a game and the bodies that belong into them.
#pragma once

#include "sim_node/scene/sdf/load_context.h"

namespace tactus::sim {

// Call after the bodies have been read.
void read_holes(LoadContext& context, const sdf::Element& world);

}  // namespace tactus::sim
