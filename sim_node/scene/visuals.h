// How visuals look: colours of <material>, by value or by the name of a Gazebo script.
#pragma once

#include <sdf/Visual.hh>

#include "sim_node/scene/load_context.h"

namespace tactus::sim {

// Sets the colours and the opacity of `visual`. Warns of a script whose colour is not known.
void read_look(const LoadContext& context, const sdf::Visual& from, VisualDef& visual);

}  // namespace tactus::sim
