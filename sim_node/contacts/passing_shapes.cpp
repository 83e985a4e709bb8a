#include "sim_node/contacts/passing_shapes.h"

#include <algorithm>
#include <limits>
#include <map>

#include "sim_node/model/index.h"

namespace tactus::sim {
namespace {

// Shapes that are apart by more pass each other; design: above the rounding of poses, and at most a tenth of the gap at which bodies rest.
constexpr double kApart_m = 1e-6;
// Relative motion in a step below which shapes do not pass each other, m.
constexpr double kStill_m = 1e-7;
// Cosine between the normal and that direction, above which they are the same: the shapes slide on each other.
constexpr double kSame = 1 - 1e-6;
// Sine of the angle between the axis of a cylinder and the normal above which it lies on its side.
constexpr double kLying = 0.9;

}  // namespace

PassingShapes::PassingShapes(const WorldDef& world, double tolerance_m) : tolerance_m_(tolerance_m) {
  std::map<int, std::shared_ptr<const std::vector<Eigen::Vector3d>>> of_mesh;
  for (const ShapeDef& s : world.shapes) {
    Hull hull;
    hull.is_static = world.bodies[index(s.body)].is_static;
    hull.is_round = s.kind == ShapeKind::kSphere || s.kind == ShapeKind::kCapsule || s.kind == ShapeKind::kCylinder;
    hull.is_bounded = s.kind != ShapeKind::kPlane && s.kind != ShapeKind::kHeightfield;
    if (s.kind == ShapeKind::kMesh) {
      auto& vertices = of_mesh[s.mesh];
      if (!vertices) vertices = std::make_shared<const std::vector<Eigen::Vector3d>>(world.meshes[index(s.mesh)].vertices);
      hull.vertices = vertices;
    } else if (hull.is_bounded) {
      hull.convex = gaps::convex_of(s);
    }
    hulls_.push_back(std::move(hull));
  }
}

Eigen::Isometry3d PassingShapes::pose_after(int shape, const Eigen::Isometry3d& pose, const BodyMotion& m, double h_s) const {
  if (hulls_[index(shape)].is_static) return pose;
  const double angle = m.spin_rad_s.norm() * h_s;
  Eigen::Isometry3d by = Eigen::Isometry3d::Identity();
  if (angle > 0) by.linear() = Eigen::AngleAxisd(angle, m.spin_rad_s.normalized()).toRotationMatrix();
  by.translation() = m.centre_m + h_s * m.velocity_m_s - by.linear() * m.centre_m;
  return by * pose;
}

Eigen::Vector3d PassingShapes::velocity_m_s(int shape, const Eigen::Isometry3d& pose, const BodyMotion& m, const Eigen::Vector3d& point_m) const {
  const Hull& hull = hulls_[index(shape)];
  return hull.is_static ? Eigen::Vector3d(0, 0, 0) : m.velocity_at(hull.is_round ? Eigen::Vector3d(pose.translation()) : point_m);
}

double PassingShapes::extent_m(int shape, const Eigen::Isometry3d& pose, const Eigen::Vector3d& along) const {
  const Hull& hull = hulls_[index(shape)];
  const Eigen::Vector3d local = pose.linear().transpose() * along;
  double furthest = -std::numeric_limits<double>::max();
  if (hull.vertices)
    for (const Eigen::Vector3d& v : *hull.vertices) furthest = std::max(furthest, local.dot(v));
  else
    furthest = local.dot(gaps::support(hull.convex, local)) + hull.convex.round_m;
  return furthest + along.dot(pose.translation());
}

Eigen::Vector3d PassingShapes::touching(int shape, const Eigen::Isometry3d& pose, const Eigen::Vector3d& along, const Eigen::Vector3d& point_m) const {
  const Hull& hull = hulls_[index(shape)];
  if (!hull.is_round) return point_m;
  const Eigen::Vector3d axis = pose.linear().col(2), centre = pose.translation();
  const double along_axis = hull.convex.core == gaps::Core::kPoint ? 0 : axis.dot(point_m - centre), half_m = hull.convex.half_m.z();
  const Eigen::Vector3d on_axis = centre + axis * std::clamp(along_axis, -half_m, half_m);
  if (hull.convex.core != gaps::Core::kCylinder) return on_axis + hull.convex.round_m * along;
  const Eigen::Vector3d radial = along - axis * axis.dot(along);
  return radial.norm() > kLying ? Eigen::Vector3d(on_axis + hull.convex.half_m.x() * radial.normalized()) : point_m;
}

void PassingShapes::turn_normals(Manifold& m, const Eigen::Isometry3d& pose_a, const BodyMotion& a, const Eigen::Isometry3d& pose_b,
                                 const BodyMotion& b, double h_s) const {
  if (!hulls_[index(m.shape_a)].is_bounded || !hulls_[index(m.shape_b)].is_bounded) return;
  // The point with the least gap at the end of the step.
  double least_m = tolerance_m_;
  Eigen::Vector3d normal, relative;
  for (const ManifoldPoint& p : m.used()) {
    if (p.depth_m > -kApart_m) return;
    const Eigen::Vector3d v = velocity_m_s(m.shape_b, pose_b, b, p.point_m) - velocity_m_s(m.shape_a, pose_a, a, p.point_m);
    const double end_m = -p.depth_m + h_s * v.dot(p.normal);
    if (end_m >= least_m) continue;
    least_m = end_m;
    normal = p.normal, relative = v;
  }
  if (least_m >= tolerance_m_ || relative.squaredNorm() * h_s * h_s < kStill_m * kStill_m) return;
  Eigen::Vector3d across = normal - relative * (relative.dot(normal) / relative.squaredNorm());
  if (across.squaredNorm() < 1 - kSame || across.squaredNorm() > kSame) return;  // head-on, or sliding
  across.normalize();
  const auto gap_m = [&](const Eigen::Isometry3d& at_a, const Eigen::Isometry3d& at_b) {
    return -extent_m(m.shape_b, at_b, -across) - extent_m(m.shape_a, at_a, across);
  };
  const double start_m = gap_m(pose_a, pose_b);
  if (!(start_m > kApart_m) || !(gap_m(pose_after(m.shape_a, pose_a, a, h_s), pose_after(m.shape_b, pose_b, b, h_s)) > kApart_m)) return;
  for (ManifoldPoint& p : m.used()) {
    p.normal = across, p.depth_m = -start_m;
    if (hulls_[index(m.shape_a)].is_round)
      p.point_m = touching(m.shape_a, pose_a, across, p.point_m) + start_m / 2 * across;
    else
      p.point_m = touching(m.shape_b, pose_b, -across, p.point_m + start_m / 2 * across) - start_m / 2 * across;
  }
}

}  // namespace tactus::sim
