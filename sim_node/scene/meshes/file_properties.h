// Properties in a mesh file, converted to an equivalent scene element.
#pragma once

#include <filesystem>
#include <sdf/Element.hh>

#include "sim_node/scene/meshes/mesh_parts.h"

namespace tactus::sim {

// An element of that name with these attributes. File names are relative to `file`, and errors name it.
sdf::ElementPtr element_of(const std::string& name, const Properties& properties,
                           const std::filesystem::path& file);

}  // namespace tactus::sim
