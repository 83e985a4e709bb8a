#include "sim_node/scene/sdf/load_context.h"

#include <stdexcept>

#include "sim_node/scene/sdf/sdf_eigen.h"

namespace tactus::sim {
namespace {

constexpr std::size_t kMaxWarnings = 1000;  // more than anyone reads (design)

}  // namespace

void LoadContext::reject(const sdf::Element& element, const std::string& sentence) const {
  throw std::runtime_error(files.where(element) + ": " + xml_path(element) + " " + sentence);
}

void LoadContext::warn(const sdf::Element& element, const std::string& sentence) const {
  // The place of a warning is found by a search through the file.
  if (warnings.size() > kMaxWarnings) return;
  warnings.push_back(warnings.size() == kMaxWarnings
                         ? "there are more than " + std::to_string(kMaxWarnings) + " warnings; the rest is left out"
                         : files.where(element) + ": " + xml_path(element) + " " + sentence);
}

std::filesystem::path LoadContext::asset_file(const std::string& uri, const sdf::Element& element) const {
  const std::filesystem::path file = files.find(uri, element.FilePath());
  if (file.empty()) reject(element, "names \"" + uri + "\", which is not found: put it beside the scene file");
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error))
    reject(element, "names \"" + uri + "\", which is not a regular file: name a regular file");
  if (!files.readable().resolve(file)) reject(element, "names \"" + uri + "\", which " + SdfFiles::kOutside);
  return file;
}

Eigen::Isometry3d LoadContext::resolve(const sdf::SemanticPose& pose, const sdf::Element& element,
                                       const std::string& resolve_to) const {
  ignition::math::Pose3d resolved;
  const sdf::Errors errors = pose.Resolve(resolved, resolve_to);
  if (!errors.empty()) reject(element, "has no pose: " + errors.front().Message());
  const Eigen::Isometry3d result = to_eigen(resolved);
  if (!result.matrix().allFinite() || result.translation().cwiseAbs().maxCoeff() > 1e6)
    reject(element, "has a pose that is not finite or farther than 1e6 m: correct its <pose>");
  return result;
}

std::string xml_path(const sdf::Element& element) {
  if (!element.XmlPath().empty()) return element.XmlPath();
  std::string path = (element.GetParent() ? xml_path(*element.GetParent()) : "") + "/" + element.GetName();
  if (element.HasAttribute("name")) path += "[@name=\"" + element.GetAttribute("name")->GetAsString() + "\"]";
  return path;
}

sdf::ElementPtr explicit_child(const sdf::ElementPtr& element, const std::string& child) {
  if (!element) return nullptr;
  for (auto each = element->GetFirstElement(); each; each = each->GetNextElement())
    if (each->GetName() == child && each->GetExplicitlySetInFile()) return each;
  return nullptr;
}

}  // namespace tactus::sim
