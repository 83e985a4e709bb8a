// The shape of a tool as a ShapeDef. Pure.
#pragma once

#include <tactus/tool_def_t.hpp>

#include "sim_node/model/world_def.h"

namespace tactus::sim {

// Whether the tool has a shape with torque feedback; otherwise it is a ball or a point.
inline bool is_shaped(const tool_def_t& tool) { return tool.shape != tool_def_t::BALL; }

// For a tool of a WorldDef whose shape is a mesh: its index in WorldDef::meshes. The field mesh_hash holds the index
// there, since the hash is computed only when the scene is published (scene_assets.h).
inline int tool_mesh(const tool_def_t& tool) { return static_cast<int>(tool.mesh_hash); }

// In the frame of the tool's body. A ball tool becomes a sphere of its radius.
ShapeDef tool_shape(const tool_def_t& tool);

// Radius of the bounding sphere of a shape, about the origin of its frame, and so the lever arm of the points that a
// rotation moves.
double bound_m(const WorldDef& world, const ShapeDef& shape);

}  // namespace tactus::sim
