// Geometry of collisions and visuals.
#pragma once

#include <optional>

#include "sim_node/scene/sdf/load_context.h"

namespace tactus::sim {

// Reads kind, size, mesh and pose (in the body frame, including the geometry's own: a plane is rotated to its
// normal). Empty for unsupported geometry. Rejects sizes that are not positive and unreadable files. `owner`: the
// <collision> or <visual>.
std::optional<ShapeDef> read_shape(LoadContext& context, const sdf::Element& owner, const Eigen::Isometry3d& pose);

// The element of the shape in the <geometry> of `owner`: "box", "mesh", ...; nullptr: none.
const sdf::Element* geometry_of(const sdf::Element& owner);

// Smallest box in the body frame that contains the shape; empty for a plane.
Eigen::AlignedBox3d bounds(const WorldDef& world, const ShapeDef& shape);

}  // namespace tactus::sim
