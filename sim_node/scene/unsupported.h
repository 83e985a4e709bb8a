// Warnings for elements of a scene that have no effect: one per element, and none for its children.
#pragma once

#include "sim_node/scene/sdf/load_context.h"

namespace tactus::sim {

// Also warns of a step size or rate in <physics> that differs from the fixed one. `root`: <sdf>.
void warn_unsupported(const LoadContext& context, const sdf::Element& root);

}  // namespace tactus::sim
