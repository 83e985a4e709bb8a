// Mass and inertia of a link, from <inertial> or, for missing values, from its shapes.
#pragma once

#include <span>

#include "sim_node/scene/sdf/load_context.h"

namespace tactus::sim {

// Without <mass>: the mass by the materials of the shapes, or SDF's 1 kg when a shape has no material. Without
// <inertia>: the inertia of the shapes, scaled to the mass. With <inertial auto="true"> (SDFormat 1.11): both from the
// shapes, whose density is that of <collision>, else of <inertial>, else of their material, else 1000 kg/m^3; <mass> scales
// them. Rejects a mass that is not positive and an inertia that is not positive definite.
// shapes: those of the collisions of the link.
void read_inertial(const LoadContext& context, const sdf::Element& link, std::span<const ShapeDef> shapes,
                   BodyDef& body);

}  // namespace tactus::sim
