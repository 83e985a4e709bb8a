// Properties in a mesh file, converted to an equivalent scene element.
#pragma once

#include <filesystem>
#include <memory>

#include "sim_node/scene/meshes/mesh_parts.h"
#include "sim_node/scene/sdf/element.h"

namespace tactus::sim {

struct FileElement {
  std::string name;
  sdf::Source source;
  sdf::Element element;
};

// An element of that name with these attributes. File names are relative to `file`, and errors name it. `properties` must
// outlive the element.
std::unique_ptr<const FileElement> element_of(const std::string& name, const Properties& properties,
                                              const std::filesystem::path& file);

}  // namespace tactus::sim
