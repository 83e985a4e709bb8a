#include "sim_node/scene/sdf/model_folder.h"

#include <tinyxml2.h>

#include <charconv>
#include <stdexcept>
#include <string>

#include "sim_node/scene/sdf/element.h"
#include "sync/sandbox/regular_file.h"

namespace tactus::sim::sdf {
namespace {

constexpr std::uintmax_t kMaxConfigBytes = 64 << 10;

}  // namespace

std::optional<int> minor_version(std::string_view version) {
  if (!version.starts_with("1.")) return std::nullopt;
  version.remove_prefix(2);
  // "1.9.1" is a version of 1.9.
  const std::string_view minor = version.substr(0, version.find('.'));
  int number = 0;
  const auto [end, error] = std::from_chars(minor.data(), minor.data() + minor.size(), number);
  if (error != std::errc{} || end != minor.data() + minor.size() || number < 0) return std::nullopt;
  return number;
}

std::filesystem::path file_of_model_folder(const std::filesystem::path& folder) {
  tinyxml2::XMLDocument config;
  try {
    const std::string text = sync::read_regular_text(folder / "model.config", kMaxConfigBytes);
    if (config.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS) return {};
  } catch (const std::runtime_error&) {
    return {};
  }
  const tinyxml2::XMLElement* model = config.FirstChildElement("model");
  std::filesystem::path found;
  int newest = -1;
  for (const auto* sdf = model ? model->FirstChildElement("sdf") : nullptr; sdf; sdf = sdf->NextSiblingElement("sdf")) {
    const char* version = sdf->Attribute("version");
    // A file without a version is taken when there is no other.
    const int number = minor_version(version ? version : "").value_or(0);
    if (!sdf->GetText() || number > kNewestVersion || number <= newest) continue;
    newest = number;
    found = folder / std::string(trimmed(sdf->GetText()));
  }
  return found;
}

}  // namespace tactus::sim::sdf
