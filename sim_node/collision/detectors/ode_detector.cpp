#include <cmath>

#include "sim_node/collision/detector.h"
#include "sim_node/collision/detectors/ode_geoms.h"

namespace tactus::sim {
namespace {

// Two boxes have at most 8 points. Meshes have many more.
constexpr int kMaxRaw = 64;

class OdeDetector : public Detector {
 public:
  OdeDetector() : raw_(kMaxRaw) {}
  ~OdeDetector() override {
    for (const Shape& s : shapes_) dGeomDestroy(s.geom);
  }
  OdeDetector(const OdeDetector&) = delete;
  OdeDetector& operator=(const OdeDetector&) = delete;

  DetectorAbilities abilities() const override {
    return {.name = "ode",
            .separation = false,
            .both_surfaces = false,
            .overlap_depth = true,
            .contact_kind = false,
            .one_pair = false,
            .deterministic = true};
  }

  int add(const ShapeDef& shape, const WorldDef& world) override {
    Shape s{shape, Eigen::Isometry3d::Identity(), geoms_.make(world, shape, true, Eigen::Isometry3d::Identity())};
    if (shape.kind == ShapeKind::kHeightfield) s.offset = ode::Geoms::geom_pose(world, shape, s.offset);
    shapes_.push_back(s);
    return static_cast<int>(shapes_.size()) - 1;
  }

  void query(int a, const Eigen::Isometry3d& pose_a, int b, const Eigen::Isometry3d& pose_b, double,
             std::vector<PointPair>& out) override {
    out.clear();
    const Shape &sa = shapes_[static_cast<std::size_t>(a)], &sb = shapes_[static_cast<std::size_t>(b)];
    put(sa, pose_a);
    put(sb, pose_b);
    const int count = dCollide(sa.geom, sb.geom, kMaxRaw, raw_.data(), sizeof(dContactGeom));
    for (int i = 0; i < count; ++i) {
      const dContactGeom& c = raw_[static_cast<std::size_t>(i)];
      PointPair p;
      p.normal = -ode::to_eigen(c.normal);  // ODE's normal points into its first geometry
      p.gap_m = -c.depth;
      const Eigen::Vector3d at = ode::to_eigen(c.pos);
      if (!p.normal.allFinite() || !at.allFinite() || std::abs(p.normal.norm() - 1) > 1e-3) continue;
      // For a capsule against a mesh, ODE also reports the near side of the axis, without depth.
      if (c.depth <= 0 && count > 1) continue;
      p.on_a_m = at - 0.5 * p.gap_m * p.normal;
      p.on_b_m = at + 0.5 * p.gap_m * p.normal;
      if (sa.shape.kind == ShapeKind::kMesh) p.triangle_a = c.side1;
      if (sb.shape.kind == ShapeKind::kMesh) p.triangle_b = c.side2;
      out.push_back(p);
    }
  }

 protected:
  // ODE does not test static geometry against static geometry.
  bool supports(ShapeKind a, ShapeKind b) const override {
    const auto ground = [](ShapeKind k) { return k == ShapeKind::kPlane || k == ShapeKind::kHeightfield; };
    return !(ground(a) && ground(b));
  }

 private:
  struct Shape {
    ShapeDef shape;
    Eigen::Isometry3d offset;  // of ODE's geometry in the frame of the shape
    dGeomID geom;
  };

  static void put(const Shape& s, const Eigen::Isometry3d& pose) {
    if (s.shape.kind == ShapeKind::kPlane) {
      const Eigen::Vector3d n = pose.linear().col(2).normalized();
      dGeomPlaneSetParams(s.geom, n.x(), n.y(), n.z(), n.dot(pose.translation()));
      return;
    }
    const Eigen::Isometry3d at = pose * s.offset;
    dQuaternion q;
    ode::set_quaternion(Eigen::Quaterniond(at.linear()).normalized(), q);
    dGeomSetPosition(s.geom, at.translation().x(), at.translation().y(), at.translation().z());
    dGeomSetQuaternion(s.geom, q);
  }

  ode::Library library_;
  ode::Geoms geoms_;
  std::vector<Shape> shapes_;
  std::vector<dContactGeom> raw_;
};

}  // namespace

std::unique_ptr<Detector> make_ode_detector() { return std::make_unique<OdeDetector>(); }

}  // namespace tactus::sim
