// What a mesh file says with our words, as the element of a scene that would say the same.
#pragma once

#include <filesystem>
#include <sdf/Element.hh>

#include "sim_node/scene/meshes/mesh_parts.h"

namespace tactus::sim {

// An element of that name with these attributes; files that they name are looked for beside `file`, and what is
// wrong with them is said with its name.
sdf::ElementPtr element_of(const std::string& name, const Properties& properties,
                           const std::filesystem::path& file);

}  // namespace tactus::sim
