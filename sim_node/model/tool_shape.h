// The shape of a tool, as shapes of bodies are. Pure.
#pragma once

#include <tactus/tool_def_t.hpp>

#include "sim_node/model/world_def.h"

namespace tactus::sim {

// Whether it has one that is felt with torque; else it is a ball or a point.
inline bool is_shaped(const tool_def_t& tool) { return tool.shape != tool_def_t::BALL; }

// Of a tool of a WorldDef whose shape is a mesh, its index in WorldDef::meshes: there the field mesh_hash holds
// that, since the hash is known only when the scene is told (scene_assets.h).
inline int tool_mesh(const tool_def_t& tool) { return static_cast<int>(tool.mesh_hash); }

// In the frame of the tool's body; of a ball, a sphere of its radius.
ShapeDef tool_shape(const tool_def_t& tool);

// Of a ball around the tool, about the origin of its body.
double tool_bound_m(const WorldDef& world, const tool_def_t& tool);

}  // namespace tactus::sim
