#include <stdexcept>
#include <utility>

#include "sim_node/collision/detector.h"
#include "sim_node/collision/detectors/mesh_trees.h"

namespace tactus::sim {
namespace {

class LayersDetector : public Detector {
 public:
  LayersDetector(const MeshContactOptions& options, std::shared_ptr<MeshTrees> trees)
      : trees_(std::move(trees)), contact_(options) {}

  DetectorAbilities abilities() const override {
    return {.name = "layers",
            .separation = true,
            .both_surfaces = true,
            .overlap_depth = false,
            .contact_kind = true,
            .one_pair = false,
            .deterministic = true};
  }

  int add(const ShapeDef& shape, const WorldDef& world) override {
    if (!supports(shape.kind, shape.kind)) throw std::runtime_error(unsupported_reason(shape.kind, shape.kind));
    const ContactMesh& ready = *meshes_.emplace_back(trees_->layers(shape, world));
    contact_.check_supported(ready, ready);
    return static_cast<int>(meshes_.size()) - 1;
  }

  void query(int a, const Eigen::Isometry3d& pose_a, int b, const Eigen::Isometry3d& pose_b, double reach_m,
             std::vector<PointPair>& out) override {
    contact_.query(*meshes_[static_cast<std::size_t>(a)], pose_a, *meshes_[static_cast<std::size_t>(b)], pose_b,
                   {reach_m, kEqualShare * reach_m}, found_);
    out.assign(found_.pairs.begin(), found_.pairs.end());
  }

 protected:
  bool supports(ShapeKind a, ShapeKind b) const override {
    for (const ShapeKind k : {a, b})
      if (k != ShapeKind::kMesh && k != ShapeKind::kBox && k != ShapeKind::kHeightfield) return false;
    return true;
  }

 private:
  std::shared_ptr<MeshTrees> trees_;
  std::vector<std::shared_ptr<const ContactMesh>> meshes_;
  MeshContact contact_;
  MeshContactResult found_;
};

}  // namespace

std::unique_ptr<Detector> make_layers_detector(const MeshContactOptions& options, std::shared_ptr<MeshTrees> trees) {
  if (!trees) trees = std::make_shared<MeshTrees>();
  return std::make_unique<LayersDetector>(options, std::move(trees));
}

}  // namespace tactus::sim
