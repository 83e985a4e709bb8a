// Materials of a scene: the built-in table, additions and changes by <tactus:material>, and their assignment to
// surfaces.
#pragma once

#include "sim_node/scene/sdf/load_context.h"
#include "sim_node/scene/meshes/mesh_parts.h"

namespace tactus::sim {

// Fills world.materials. Rejects a new material that lacks a value and names no base.
void read_materials(LoadContext& context, const sdf::Element& world);

// Index of the material that a mesh file names: an existing one if only `base` is given, else a new one with the
// given changes.
int define_material(LoadContext& context, const Properties& properties, const std::filesystem::path& file);

// Index of the material that <tactus:surface material="..."/> in `element` names, else `inherited`. element: may be nullptr.
int surface_material(const LoadContext& context, const sdf::Element* element, int inherited);

}  // namespace tactus::sim
