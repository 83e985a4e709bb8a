// The mass of a link: as <inertial> says, and what it leaves out from the shapes.
#pragma once

#include <span>

#include "sim_node/scene/sdf/load_context.h"

namespace tactus::sim {

// No <mass>: that of the shapes' materials, or SDF's 1 kg where one has no material. No <inertia>: that of the shapes,
// in proportion to the mass. Refuses a mass that is not positive and an inertia that is not positive definite.
void read_inertial(const LoadContext& context, const sdf::ElementPtr& link, std::span<const ShapeDef> shapes,
                   BodyDef& body);

}  // namespace tactus::sim
