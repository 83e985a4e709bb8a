#include "sim_node/scene/meshes/file_properties.h"

namespace tactus::sim {

sdf::ElementPtr element_of(const std::string& name, const Properties& properties,
                           const std::filesystem::path& file) {
  auto element = std::make_shared<sdf::Element>();
  element->SetName(name);
  element->SetFilePath(file.string());
  for (const auto& [key, value] : properties) element->AddAttribute(key, "string", value, false, "");
  return element;
}

}  // namespace tactus::sim
