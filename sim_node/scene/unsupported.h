// Says what of a scene has no effect here: one warning for each such element, and none for what lies inside it.
#pragma once

#include "sim_node/scene/sdf/load_context.h"

namespace tactus::sim {

// Also warns of a step size or rate of <physics> that is not ours. `root` is <sdf>.
void warn_unsupported(const LoadContext& context, const sdf::ElementPtr& root);

}  // namespace tactus::sim
