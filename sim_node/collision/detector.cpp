#include "sim_node/collision/detector.h"

#include <map>
#include <stdexcept>
#include <utility>

namespace tactus::sim {
namespace {

std::string_view shape_word(ShapeKind kind) {
  switch (kind) {
    case ShapeKind::kBox: return "box";
    case ShapeKind::kSphere: return "sphere";
    case ShapeKind::kCylinder: return "cylinder";
    case ShapeKind::kCapsule: return "capsule";
    case ShapeKind::kPlane: return "plane";
    case ShapeKind::kMesh: return "mesh";
    case ShapeKind::kHeightfield: break;
  }
  return "heightfield";
}

constexpr std::string_view kCustom = "custom:";

// Written before run() only, by the main function of a program that links this library.
std::map<std::string, std::function<std::unique_ptr<Detector>()>, std::less<>>& registered_detectors() {
  static std::map<std::string, std::function<std::unique_ptr<Detector>()>, std::less<>> all;
  return all;
}

}  // namespace

std::string Detector::unsupported_reason(ShapeKind a, ShapeKind b) const {
  if (supports(a, b)) return "";
  return "sim_node: the detector \"" + std::string(abilities().name) + "\" does not support a " + std::string(shape_word(a)) +
         " against a " + std::string(shape_word(b)) + "; choose \"ode\", which supports every pair";
}

void register_detector(std::string name, std::function<std::unique_ptr<Detector>()> make) {
  if (name.empty() || !registered_detectors().try_emplace(name, std::move(make)).second)
    throw std::invalid_argument("sim_node: the detector \"" + name + "\" has no name, or is registered twice; give each its own name");
}

std::unique_ptr<Detector> make_detector(std::string_view name, const MeshContactOptions& layers,
                                        std::shared_ptr<MeshTrees> trees) {
  if (name == "ode") return make_ode_detector();
  if (name == "ccd" || name == "ccd_mpr") return make_ccd_detector(name == "ccd_mpr");
  if (name == "layers") return make_layers_detector(layers, std::move(trees));
  if (name == "gaps" || name == "auto") return make_gaps_detector(layers, std::move(trees));
  if (name == "fcl") {
    if (auto fcl = make_fcl_detector()) return fcl;
    throw std::runtime_error(
        "sim_node: the detector \"fcl\" was not built in; install libfcl-dev and build again, or choose \"ode\"");
  }
  if (name.starts_with(kCustom)) {
    const auto& all = registered_detectors();
    if (const auto i = all.find(name.substr(kCustom.size())); i != all.end()) return i->second();
    throw std::runtime_error("sim_node: the detector \"" + std::string(name) +
                             "\" is not part of this program; start the program that registers it");
  }
  throw std::runtime_error("sim_node: the detector \"" + std::string(name) +
                           "\" is unknown; choose auto, gaps, layers, ode, ccd, ccd_mpr or fcl");
}

}  // namespace tactus::sim
