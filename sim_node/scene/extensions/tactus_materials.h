// The materials of a scene: the built-in table, what <tactus:material> adds to it or changes, and who wears which.
#pragma once

#include "sim_node/scene/sdf/load_context.h"
#include "sim_node/scene/meshes/mesh_parts.h"

namespace tactus::sim {

// Fills world.materials. Refuses a new material that lacks a figure and names no base to take it from.
void read_materials(LoadContext& context, const sdf::ElementPtr& world);

// Index of the material that a mesh file says it is made of: one that there is, by its name as `base` alone, or that one with
// what is said besides.
int define_material(LoadContext& context, const Properties& properties, const std::filesystem::path& file);

// Index of the material that <tactus:surface material="..."/> in `element` names, else `inherited`.
int surface_material(const LoadContext& context, const sdf::ElementPtr& element, int inherited);

}  // namespace tactus::sim
