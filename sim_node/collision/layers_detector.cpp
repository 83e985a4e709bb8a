#include <deque>
#include <stdexcept>

#include "sim_node/collision/detector.h"
#include "sim_node/scene/triangles.h"

namespace tactus::sim {
namespace {

// Distances within the tolerance that differ by less than this share of it are alike: as I-Touch's example, 2
// of 10.
constexpr double kMargin = 0.2;
// Samples along one side of a heightfield; finer ones are thinned.
constexpr int kMostSamples = 1025;

TriangleMesh mesh_of_box(const Eigen::Vector3d& size) {
  TriangleMesh m;
  for (int i = 0; i < 8; ++i)
    m.vertices.push_back(
        Eigen::Vector3d(i & 1 ? 0.5 : -0.5, i & 2 ? 0.5 : -0.5, i & 4 ? 0.5 : -0.5).cwiseProduct(size));
  m.indices = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
               2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
  return m;
}

class LayersDetector : public Detector {
 public:
  explicit LayersDetector(const MeshContactOptions& options) : contact_(options) {}

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
    if (!takes(shape.kind, shape.kind)) throw std::runtime_error(refusal(shape.kind, shape.kind));
    const auto at = static_cast<std::size_t>(shape.mesh);
    TriangleMesh made;
    if (shape.kind == ShapeKind::kBox) made = mesh_of_box(shape.size_m);
    if (shape.kind == ShapeKind::kHeightfield) made = triangulate(world.heightfields.at(at), kMostSamples);
    const TriangleMesh& mesh = shape.kind == ShapeKind::kMesh ? world.meshes.at(at) : made;
    const ContactMesh& ready = meshes_.emplace_back(mesh.vertices, mesh.indices);
    contact_.accept(ready, ready);
    return static_cast<int>(meshes_.size()) - 1;
  }

  void query(int a, const Eigen::Isometry3d& pose_a, int b, const Eigen::Isometry3d& pose_b, double reach_m,
             std::vector<PointPair>& out) override {
    contact_.query(meshes_[static_cast<std::size_t>(a)], pose_a, meshes_[static_cast<std::size_t>(b)], pose_b,
                   {reach_m, kMargin * reach_m}, found_);
    out.assign(found_.pairs.begin(), found_.pairs.end());
  }

 protected:
  bool takes(ShapeKind a, ShapeKind b) const override {
    for (const ShapeKind k : {a, b})
      if (k != ShapeKind::kMesh && k != ShapeKind::kBox && k != ShapeKind::kHeightfield) return false;
    return true;
  }

 private:
  std::deque<ContactMesh> meshes_;
  MeshContact contact_;
  MeshContactResult found_;
};

}  // namespace

std::unique_ptr<Detector> make_layers_detector(const MeshContactOptions& options) {
  return std::make_unique<LayersDetector>(options);
}

}  // namespace tactus::sim
