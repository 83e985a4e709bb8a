#include "sim_node/collision/detector.h"

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

}  // namespace

std::string Detector::unsupported_reason(ShapeKind a, ShapeKind b) const {
  if (supports(a, b)) return "";
  return "sim_node: the detector \"" + std::string(abilities().name) + "\" does not support a " + std::string(shape_word(a)) +
         " against a " + std::string(shape_word(b)) + "; choose \"ode\", which supports every pair";
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
  throw std::runtime_error("sim_node: the detector \"" + std::string(name) +
                           "\" is unknown; choose auto, gaps, layers, ode, ccd, ccd_mpr or fcl");
}

}  // namespace tactus::sim
