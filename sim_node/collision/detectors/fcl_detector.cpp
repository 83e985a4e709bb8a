#include "sim_node/collision/detector.h"

#ifdef TACTUS_WITH_FCL
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>

#include <stdexcept>

namespace tactus::sim {
namespace {

constexpr std::size_t kMaxFclContacts = 64;

class FclDetector : public Detector {
 public:
  DetectorAbilities abilities() const override {
    return {.name = "fcl",
            .separation = true,
            .both_surfaces = true,
            .overlap_depth = true,
            .contact_kind = false,
            .one_pair = false,
            .deterministic = true};
  }

  int add(const ShapeDef& shape, const WorldDef& world) override {
    if (!supports(shape.kind, shape.kind)) throw std::runtime_error(unsupported_reason(shape.kind, shape.kind));
    shapes_.emplace_back(geometry(shape, world));
    kinds_.push_back(shape.kind);
    return static_cast<int>(shapes_.size()) - 1;
  }

  void query(int a, const Eigen::Isometry3d& pose_a, int b, const Eigen::Isometry3d& pose_b, double reach_m,
             std::vector<PointPair>& out) override {
    out.clear();
    const fcl::CollisionGeometryd &ga = *shapes_[static_cast<std::size_t>(a)],
                                  &gb = *shapes_[static_cast<std::size_t>(b)];
    const bool mesh_a = kinds_[static_cast<std::size_t>(a)] == ShapeKind::kMesh,
               mesh_b = kinds_[static_cast<std::size_t>(b)] == ShapeKind::kMesh;
    fcl::DistanceResultd apart;
    fcl::DistanceRequestd request(true);
    request.gjk_solver_type = fcl::GJKSolverType::GST_INDEP;  // the libccd solver asserts on flat contacts
    const double gap = fcl::distance(&ga, pose_a, &gb, pose_b, request, apart);
    if (gap > reach_m) return;
    PointPair p;
    if (gap > 0) {
      p.gap_m = gap;
      p.on_a_m = apart.nearest_points[0], p.on_b_m = apart.nearest_points[1];
      p.normal = (p.on_b_m - p.on_a_m).normalized();
      if (mesh_a) p.triangle_a = static_cast<int>(apart.b1);
      if (mesh_b) p.triangle_b = static_cast<int>(apart.b2);
      out.push_back(p);
      return;
    }
    fcl::CollisionRequestd collide(kMaxFclContacts, true);
    collide.gjk_solver_type = fcl::GJKSolverType::GST_INDEP;
    fcl::CollisionResultd touching;
    fcl::collide(&ga, pose_a, &gb, pose_b, collide, touching);
    for (std::size_t i = 0; i < touching.numContacts(); ++i) {
      const fcl::Contactd& c = touching.getContact(i);
      p.normal = c.normal;
      p.gap_m = -c.penetration_depth;
      p.on_a_m = c.pos - 0.5 * p.gap_m * p.normal;
      p.on_b_m = c.pos + 0.5 * p.gap_m * p.normal;
      p.triangle_a = mesh_a ? static_cast<int>(c.b1) : -1;
      p.triangle_b = mesh_b ? static_cast<int>(c.b2) : -1;
      out.push_back(p);
    }
  }

 protected:
  bool supports(ShapeKind a, ShapeKind b) const override {
    for (const ShapeKind k : {a, b})
      if (k == ShapeKind::kPlane || k == ShapeKind::kHeightfield) return false;
    return true;
  }

 private:
  static std::shared_ptr<fcl::CollisionGeometryd> geometry(const ShapeDef& shape, const WorldDef& world) {
    const Eigen::Vector3d& s = shape.size_m;
    switch (shape.kind) {
      case ShapeKind::kBox: return std::make_shared<fcl::Boxd>(s.x(), s.y(), s.z());
      case ShapeKind::kSphere: return std::make_shared<fcl::Sphered>(s.x());
      case ShapeKind::kCylinder: return std::make_shared<fcl::Cylinderd>(s.x(), s.z());
      case ShapeKind::kCapsule: return std::make_shared<fcl::Capsuled>(s.x(), s.z());
      default: break;
    }
    const TriangleMesh& mesh = world.meshes.at(static_cast<std::size_t>(shape.mesh));
    // OBBRSS is the only bounding volume for which FCL does not copy the mesh at every query.
    auto model = std::make_shared<fcl::BVHModel<fcl::OBBRSSd>>();
    std::vector<fcl::Triangle> triangles;
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3)
      triangles.emplace_back(mesh.indices[i], mesh.indices[i + 1], mesh.indices[i + 2]);
    model->beginModel();
    model->addSubModel(mesh.vertices, triangles);
    model->endModel();
    return model;
  }

  std::vector<std::shared_ptr<fcl::CollisionGeometryd>> shapes_;
  std::vector<ShapeKind> kinds_;
};

}  // namespace

std::unique_ptr<Detector> make_fcl_detector() { return std::make_unique<FclDetector>(); }

}  // namespace tactus::sim

#else

namespace tactus::sim {

std::unique_ptr<Detector> make_fcl_detector() { return nullptr; }

}  // namespace tactus::sim

#endif
