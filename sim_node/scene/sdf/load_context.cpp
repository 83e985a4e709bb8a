#include "sim_node/scene/sdf/load_context.h"

namespace tactus::sim {
namespace {

constexpr double kMaxDistance_m = 1e6;

}  // namespace

void LoadContext::reject(const sdf::Element& element, const std::string& sentence) const {
  sdf::reject(element, sentence);
}

void LoadContext::warn(const sdf::Element& element, const std::string& sentence) const {
  sdf::add_warning(warnings, sdf::message(element, sentence));
}

std::filesystem::path LoadContext::asset_file(const std::string& uri, const sdf::Element& element) const {
  const std::filesystem::path file = files.find(uri, element.source->file);
  if (file.empty()) reject(element, "names \"" + uri + "\", which is not found: put it beside the scene file");
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error))
    reject(element, "names \"" + uri + "\", which is not a regular file: name a regular file");
  if (!files.readable().resolve(file)) reject(element, "names \"" + uri + "\", which " + SdfFiles::kOutside);
  return file;
}

Eigen::Isometry3d LoadContext::resolve(const sdf::Element& element) const {
  const bool is_frame = element.name == "model" || element.name == "link" || element.name == "joint" || element.name == "frame";
  const Eigen::Isometry3d result = (is_frame ? frames.pose(element) : frames.pose_inside(element)).to_eigen();
  if (!result.matrix().allFinite() || result.translation().cwiseAbs().maxCoeff() > kMaxDistance_m)
    reject(element, "has a pose that is not finite or farther than 1e6 m: correct its <pose>");
  return result;
}

}  // namespace tactus::sim
