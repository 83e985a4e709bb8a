#include "sim_node/scene/meshes/file_properties.h"

namespace tactus::sim {

std::unique_ptr<const FileElement> element_of(const std::string& name, const Properties& properties,
                                              const std::filesystem::path& file) {
  auto made = std::make_unique<FileElement>(FileElement{name, {file, file.string(), 0}, {}});
  made->element.name = made->name;
  made->element.source = &made->source;
  for (const auto& [key, value] : properties) made->element.attributes.push_back({key, sdf::trimmed(value)});
  return made;
}

}  // namespace tactus::sim
