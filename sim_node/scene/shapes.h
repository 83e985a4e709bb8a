// Geometry of collisions and visuals.
#pragma once

#include <optional>
#include <sdf/Geometry.hh>

#include "sim_node/scene/sdf/load_context.h"

namespace tactus::sim {

// Kind, size, mesh and pose (the geometry's own, in the body frame: a plane is turned to its normal). Nothing for
// geometry that is not supported. Refuses sizes that are not positive and files that cannot be read. `owner` is the
// <collision> or <visual>.
std::optional<ShapeDef> read_shape(LoadContext& context, const sdf::Geometry& geometry, const sdf::ElementPtr& owner,
                                   const Eigen::Isometry3d& pose);

// Smallest box in the body frame that holds the shape; empty for a plane.
Eigen::AlignedBox3d bounds(const WorldDef& world, const ShapeDef& shape);

}  // namespace tactus::sim
