// The materials of a scene: the built-in table, what <tactus:material> adds to it or changes, and who wears which.
#pragma once

#include "sim_node/scene/load_context.h"

namespace tactus::sim {

// Fills world.materials. Refuses a new material that lacks a figure and names no base to take it from.
void read_materials(LoadContext& context, const sdf::ElementPtr& world);

// Index of the material that <tactus:surface material="..."/> in `element` names, else `inherited`.
int surface_material(const LoadContext& context, const sdf::ElementPtr& element, int inherited);

}  // namespace tactus::sim
