#include "scripts/simulated_player/viewer.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tactus::simulated_player {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kDiscShare = 0.8;  // design: inside the silhouette, so that a ball on a floor is not hidden by the floor
constexpr int kDiscPoints = 6;
constexpr float kOpaque = 0.5F;
constexpr double kDefaultFov_rad = std::numbers::pi / 3;  // of visual_node

Isometry3d isometry(const pose_t& p) {
  Isometry3d t = Isometry3d::Identity();
  t.translation() = Vector3d(p.position_m.x, p.position_m.y, p.position_m.z);
  const Eigen::Quaterniond q(p.orientation.w, p.orientation.x, p.orientation.y, p.orientation.z);
  if (q.norm() > 0) t.linear() = q.normalized().toRotationMatrix();
  return t;
}

// The part [t0, t1] of the segment from a to b between the two planes coordinate = +-half. False: none.
bool clip_to_slab(double a, double b, double half, double& t0, double& t1) {
  const double d = b - a;
  if (std::abs(d) < 1e-12) return std::abs(a) < half;
  const double u = (-half - a) / d, v = (half - a) / d;
  t0 = std::max(t0, std::min(u, v)), t1 = std::min(t1, std::max(u, v));
  return t0 < t1;
}

bool crosses_box(const Vector3d& a, const Vector3d& b, const Vector3d& half) {
  double t0 = 0, t1 = 1;
  for (int i = 0; i < 3; ++i)
    if (!clip_to_slab(a[i], b[i], half[i], t0, t1)) return false;
  return true;
}

bool crosses_sphere(const Vector3d& a, const Vector3d& b, const Vector3d& centre, double radius) {
  const Vector3d d = b - a;
  const double t = std::clamp(d.dot(centre - a) / std::max(d.squaredNorm(), 1e-18), 0.0, 1.0);
  return (a + t * d - centre).norm() < radius;
}

bool crosses_cylinder(const Vector3d& a, const Vector3d& b, double radius, double half) {
  const Eigen::Vector2d from = a.head<2>(), d = (b - a).head<2>();
  const double aa = d.squaredNorm(), ab = from.dot(d), c = from.squaredNorm() - radius * radius;
  double t0 = 0, t1 = 1;
  if (aa > 1e-18) {
    const double root = ab * ab - aa * c;
    if (root <= 0) return false;
    t0 = std::max(t0, (-ab - std::sqrt(root)) / aa), t1 = std::min(t1, (-ab + std::sqrt(root)) / aa);
  } else if (c >= 0) {
    return false;
  }
  return t0 < t1 && clip_to_slab(a.z(), b.z(), half, t0, t1);
}

bool crosses(int kind, const Vector3d& size, const Vector3d& a, const Vector3d& b) {
  switch (kind) {
    case shape_def_t::BOX: return crosses_box(a, b, size / 2);
    case shape_def_t::SPHERE: return crosses_sphere(a, b, Vector3d::Zero(), size.x());
    case shape_def_t::CYLINDER: return crosses_cylinder(a, b, size.x(), size.z() / 2);
    case shape_def_t::CAPSULE:
      return crosses_cylinder(a, b, size.x(), size.z() / 2) || crosses_sphere(a, b, {0, 0, size.z() / 2}, size.x()) ||
             crosses_sphere(a, b, {0, 0, -size.z() / 2}, size.x());
    case shape_def_t::PLANE: return a.z() * b.z() < 0;
    default: return false;
  }
}

double bound_of(int kind, const Vector3d& size) {
  switch (kind) {
    case shape_def_t::BOX: return size.norm() / 2;
    case shape_def_t::SPHERE: return size.x();
    case shape_def_t::CYLINDER: return std::hypot(size.x(), size.z() / 2);
    case shape_def_t::CAPSULE: return size.x() + size.z() / 2;
    default: return 0;
  }
}

}  // namespace

SightLine Viewer::line_to(const Vector3d& point_m) const {
  SightLine line;
  const Vector3d sight = point_m - eye_m;
  line.distance_m = std::max(sight.norm(), 1e-6);
  const double along = std::hypot(sight.x(), sight.y());
  line.away = along > 1e-6 ? Vector3d(sight.x() / along, sight.y() / along, 0) : Vector3d(1, 0, 0);
  line.right = line.away.cross(Vector3d::UnitZ());
  line.sine = -sight.z() / line.distance_m, line.cosine = along / line.distance_m;
  line.up = line.sine * line.away + line.cosine * Vector3d::UnitZ();
  return line;
}

Viewer viewer_of(const scene_t& scene, int width_px) {
  Viewer viewer;
  const Isometry3d camera = isometry(scene.camera);
  viewer.eye_m = camera.translation();
  // SDF: the camera looks along +x, +y is its left.
  viewer.axes.col(0) = -camera.linear().col(1);
  viewer.axes.col(1) = camera.linear().col(2);
  viewer.axes.col(2) = camera.linear().col(0);
  const double fov = scene.camera_fov_rad > 0 ? scene.camera_fov_rad : kDefaultFov_rad;
  viewer.focal_px = width_px / (2 * std::tan(std::min(fov, 3.0) / 2));
  return viewer;
}

Occluders::Occluders(const scene_t& scene) {
  for (const visual_def_t& visual : scene.visuals) {
    const shape_def_t& s = visual.shape;
    if (visual.alpha < kOpaque || s.kind == shape_def_t::MESH || s.body < 0 || s.body >= scene.body_count) continue;
    const body_def_t& body = scene.bodies[static_cast<std::size_t>(s.body)];
    if (body.tool >= 0) continue;  // the drawn hand is smaller than any ball
    Shape shape{s.body, s.kind, body.is_static != 0, isometry(s.pose), {s.size_m.x, s.size_m.y, s.size_m.z}, 0};
    shape.bound_m = bound_of(shape.kind, shape.size_m);
    if (shape.fixed)
      shape.pose = isometry(body.pose) * shape.pose;
    else if (std::find(moving_.begin(), moving_.end(), s.body) == moving_.end())
      moving_.push_back(s.body);
    shapes_.push_back(shape);
  }
}

double Occluders::visible_share(const Vector3d& eye_m, const Vector3d& centre_m, double radius_m, int body,
                                const BodyPoses& poses) const {
  const Vector3d sight = (centre_m - eye_m).normalized(), side = sight.unitOrthogonal(), other = sight.cross(side);
  std::vector<Vector3d> ends{centre_m};
  for (int i = 0; i < kDiscPoints; ++i) {
    const double angle = 2 * std::numbers::pi * i / kDiscPoints;
    ends.push_back(centre_m + kDiscShare * radius_m * (std::cos(angle) * side + std::sin(angle) * other));
  }
  std::vector<bool> hidden(ends.size(), false);
  for (const Shape& shape : shapes_) {
    if (shape.body == body) continue;
    const Isometry3d pose = shape.fixed ? shape.pose : Isometry3d(poses(shape.body) * shape.pose);
    if (shape.bound_m > 0 && !crosses_sphere(eye_m, centre_m, pose.translation(), shape.bound_m + radius_m)) continue;
    const Isometry3d back = pose.inverse();
    const Vector3d eye = back * eye_m;
    for (std::size_t i = 0; i < ends.size(); ++i)
      if (!hidden[i] && crosses(shape.kind, shape.size_m, eye, back * ends[i])) hidden[i] = true;
  }
  return static_cast<double>(std::count(hidden.begin(), hidden.end(), false)) / static_cast<double>(ends.size());
}

}  // namespace tactus::simulated_player
