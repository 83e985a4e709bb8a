#include <ccd/ccd.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <stdexcept>

#include "sim_node/collision/detector.h"

namespace tactus::sim {
namespace {

using Eigen::Vector3d;

// libccd compares this value with squared distances: 10 um, below what users can perceive.
constexpr double kAccuracy_m2 = 1e-10;
// Iteration limit of libccd. Curved shapes take tens of iterations.
constexpr unsigned long kMaxRounds = 200;
// Tolerance of the convexity check: how far a vertex may stick out of the plane of a face, m. Covers the rounding of
// decimals in files.
constexpr double kConvex_m = 1e-6;

struct Convex {
  ShapeKind kind = ShapeKind::kBox;
  Vector3d size_m{1, 1, 1};
  std::vector<Vector3d> vertices;
  Vector3d centre{0, 0, 0};
};

struct Placed {
  const Convex* convex = nullptr;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  double inflate_m = 0;
};

Vector3d support_local(const Convex& c, const Vector3d& d) {
  const auto sign = [](double x) { return x < 0 ? -1.0 : 1.0; };
  const double length = d.norm(), across = std::hypot(d.x(), d.y());
  switch (c.kind) {
    case ShapeKind::kBox:
      return Vector3d(sign(d.x()) * c.size_m.x(), sign(d.y()) * c.size_m.y(), sign(d.z()) * c.size_m.z()) / 2;
    case ShapeKind::kSphere:
      return length > 0 ? Vector3d(c.size_m.x() / length * d) : Vector3d(c.size_m.x(), 0, 0);
    case ShapeKind::kCapsule: {
      const Vector3d end(0, 0, sign(d.z()) * c.size_m.z() / 2);
      return length > 0 ? Vector3d(end + c.size_m.x() / length * d) : end;
    }
    case ShapeKind::kCylinder: {
      const double z = sign(d.z()) * c.size_m.z() / 2;
      return across > 0 ? Vector3d(d.x() * c.size_m.x() / across, d.y() * c.size_m.x() / across, z)
                        : Vector3d(0, 0, z);
    }
    default:
      return *std::max_element(c.vertices.begin(), c.vertices.end(),
                               [&](const Vector3d& x, const Vector3d& y) { return x.dot(d) < y.dot(d); });
  }
}

void support(const void* object, const ccd_vec3_t* direction, ccd_vec3_t* out) {
  const Placed& p = *static_cast<const Placed*>(object);
  const Vector3d d(direction->v[0], direction->v[1], direction->v[2]);
  Vector3d at = p.pose * support_local(*p.convex, p.pose.linear().transpose() * d);
  if (d.norm() > 0) at += p.inflate_m * d.normalized();
  ccdVec3Set(out, at.x(), at.y(), at.z());
}

void centre(const void* object, ccd_vec3_t* out) {
  const Placed& p = *static_cast<const Placed*>(object);
  const Vector3d at = p.pose * p.convex->centre;
  ccdVec3Set(out, at.x(), at.y(), at.z());
}

// Returns an empty string when every vertex is behind every face, else the fault.
std::string convexity_fault(const TriangleMesh& mesh) {
  const auto at = [&](std::size_t i) { return mesh.vertices[static_cast<std::size_t>(mesh.indices[i])]; };
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const Vector3d n = (at(i + 1) - at(i)).cross(at(i + 2) - at(i));
    if (!(n.norm() > 0)) continue;
    for (const Vector3d& v : mesh.vertices)
      if ((v - at(i)).dot(n.normalized()) > kConvex_m)
        return "has vertices outside the plane of its triangle " + std::to_string(i / 3);
  }
  return mesh.vertices.size() < 4 ? "has fewer than four vertices" : "";
}

class CcdDetector : public Detector {
 public:
  explicit CcdDetector(bool mpr) : mpr_(mpr) {}

  DetectorAbilities abilities() const override {
    return {.name = mpr_ ? "ccd_mpr" : "ccd",
            .separation = !mpr_,
            .both_surfaces = false,
            .overlap_depth = true,
            .minimum_translation = !mpr_,
            .contact_kind = false,
            .one_pair = true,
            .deterministic = true};
  }

  int add(const ShapeDef& shape, const WorldDef& world) override {
    if (!supports(shape.kind, shape.kind)) throw std::runtime_error(unsupported_reason(shape.kind, shape.kind));
    Convex c{shape.kind, shape.size_m, {}, {0, 0, 0}};
    if (shape.kind == ShapeKind::kMesh) {
      const TriangleMesh& mesh = world.meshes.at(static_cast<std::size_t>(shape.mesh));
      const std::string fault = convexity_fault(mesh);
      if (!fault.empty())
        throw std::runtime_error("sim_node: the detector \"" + std::string(abilities().name) +
                                 "\" supports convex meshes only, but the mesh of shape \"" + shape.name + "\" " + fault +
                                 "; choose \"layers\" or \"ode\"");
      c.vertices = mesh.vertices;
      for (const Vector3d& v : c.vertices) c.centre += v / static_cast<double>(c.vertices.size());
    }
    shapes_.push_back(c);
    return static_cast<int>(shapes_.size()) - 1;
  }

  void query(int a, const Eigen::Isometry3d& pose_a, int b, const Eigen::Isometry3d& pose_b, double reach_m,
             std::vector<PointPair>& out) override {
    out.clear();
    // libccd reports overlap only. Both shapes are therefore inflated by half the reach, so that the overlap is the
    // reach minus the gap. The depth of MPR belongs to the pair of surfaces that its portal meets, which is too
    // inaccurate for this.
    const double reach = mpr_ ? 0 : reach_m;
    const Placed pa{&shapes_[static_cast<std::size_t>(a)], pose_a, reach / 2},
        pb{&shapes_[static_cast<std::size_t>(b)], pose_b, reach / 2};
    ccd_t ccd;
    CCD_INIT(&ccd);
    ccd.support1 = ccd.support2 = support;
    ccd.center1 = ccd.center2 = centre;
    ccd.max_iterations = kMaxRounds;
    ccd.epa_tolerance = ccd.mpr_tolerance = ccd.dist_tolerance = kAccuracy_m2;
    ccd_real_t depth = 0;
    ccd_vec3_t direction, at;
    const int missed = mpr_ ? ccdMPRPenetration(&pa, &pb, &ccd, &depth, &direction, &at)
                            : ccdGJKPenetration(&pa, &pb, &ccd, &depth, &direction, &at);
    if (missed != 0) return;
    PointPair p;
    p.normal = Vector3d(direction.v[0], direction.v[1], direction.v[2]);
    if (!(p.normal.norm() > 0.5) || !std::isfinite(depth)) return;
    p.normal.normalize();
    p.gap_m = reach - depth;
    const Vector3d between(at.v[0], at.v[1], at.v[2]);
    p.on_a_m = between - 0.5 * p.gap_m * p.normal;
    p.on_b_m = between + 0.5 * p.gap_m * p.normal;
    out.push_back(p);
  }

 protected:
  bool supports(ShapeKind a, ShapeKind b) const override {
    for (const ShapeKind k : {a, b})
      if (k == ShapeKind::kPlane || k == ShapeKind::kHeightfield) return false;
    return true;
  }

 private:
  bool mpr_;
  std::deque<Convex> shapes_;
};

}  // namespace

std::unique_ptr<Detector> make_ccd_detector(bool mpr) { return std::make_unique<CcdDetector>(mpr); }

}  // namespace tactus::sim
