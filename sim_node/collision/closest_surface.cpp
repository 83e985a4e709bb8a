#include "sim_node/collision/closest_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace tactus::sim {

using Eigen::Vector3d;

namespace {

constexpr double kTiny = 1e-12;  // m
// Tolerance of the convexity test: how far the point of a nearer plane may lie behind a farther plane, m.
constexpr double kBehind = 1e-4;
// Distances that differ by less are equal. A point closer than this to a triangle lies on it, m.
constexpr double kTie = 1e-9;

Vector3d unit_or(const Vector3d& v, const Vector3d& fallback) { return v.norm() > kTiny ? v.normalized() : fallback; }

// A sphere swept along z: a sphere (half = 0) or a capsule.
SurfacePlane swept_sphere(const Vector3d& p, double radius, double half) {
  const Vector3d axis(0, 0, std::clamp(p.z(), -half, half));
  const Vector3d n = unit_or(p - axis, Vector3d::UnitX());
  return {axis + radius * n, n, (p - axis).norm() - radius};
}

SurfacePlane box(const Vector3d& p, const Vector3d& half) {
  const Vector3d clamped = p.cwiseMax(-half).cwiseMin(half);
  if ((p - clamped).norm() > kTiny) return {clamped, (p - clamped).normalized(), (p - clamped).norm()};
  Eigen::Index axis = 0;
  const double inside = (half - p.cwiseAbs()).minCoeff(&axis);
  SurfacePlane s{p, Vector3d::Zero(), -inside};
  s.normal[axis] = p[axis] < 0 ? -1 : 1;
  s.point[axis] = s.normal[axis] * half[axis];
  return s;
}

SurfacePlane cylinder(const Vector3d& p, double radius, double half) {
  const double rho = std::hypot(p.x(), p.y());
  const Vector3d radial = rho > kTiny ? Vector3d(p.x() / rho, p.y() / rho, 0) : Vector3d::UnitX();
  const double z = std::clamp(p.z(), -half, half);
  if (rho <= radius && std::abs(p.z()) <= half) {  // inside: the nearer of side and cap
    const double up = p.z() < 0 ? -1 : 1;
    if (radius - rho < half - std::abs(p.z())) return {radial * radius + Vector3d(0, 0, p.z()), radial, rho - radius};
    return {{p.x(), p.y(), up * half}, {0, 0, up}, std::abs(p.z()) - half};
  }
  const Vector3d point = radial * std::min(rho, radius) + Vector3d(0, 0, z);
  return {point, unit_or(p - point, radial), (p - point).norm()};
}

}  // namespace

ClosestSurface::ClosestSurface(const ShapeDef& shape, std::shared_ptr<const TriangleTree> tree, double merge_angle_rad)
    : kind_(shape.kind), same_direction_(std::cos(merge_angle_rad)), size_m_(shape.size_m), tree_(std::move(tree)) {
  switch (kind_) {
    case ShapeKind::kBox: bound_m_ = 0.5 * size_m_.norm(); break;
    case ShapeKind::kSphere:
      bound_m_ = size_m_.x();
      break;
    case ShapeKind::kCylinder:
      bound_m_ = std::hypot(size_m_.x(), 0.5 * size_m_.z());
      break;
    case ShapeKind::kCapsule:
      bound_m_ = size_m_.x() + 0.5 * size_m_.z();
      break;
    case ShapeKind::kPlane: bound_m_ = std::numeric_limits<double>::infinity(); break;
    case ShapeKind::kMesh:
    case ShapeKind::kHeightfield:
      if (!tree_ || tree_->empty()) break;
      centre_ = tree_->box().center();
      bound_m_ = 0.5 * tree_->box().sizes().norm();
      break;
  }
}

SurfacePlane ClosestSurface::primitive(const Vector3d& p) const {
  switch (kind_) {
    case ShapeKind::kBox: return box(p, 0.5 * size_m_);
    case ShapeKind::kSphere: return swept_sphere(p, size_m_.x(), 0);
    case ShapeKind::kCapsule: return swept_sphere(p, size_m_.x(), 0.5 * size_m_.z());
    case ShapeKind::kCylinder: return cylinder(p, size_m_.x(), 0.5 * size_m_.z());
    default: return {{p.x(), p.y(), 0}, Vector3d::UnitZ(), p.z()};
  }
}

void ClosestSurface::query(const Vector3d& place, double reach_m, std::vector<SurfacePlane>& out) const {
  out.clear();
  if (kind_ == ShapeKind::kMesh || kind_ == ShapeKind::kHeightfield) return mesh_planes(place, reach_m, out);
  const SurfacePlane plane = primitive(place);
  if (plane.distance_m <= reach_m) out.push_back(plane);
}

// Returns false when the candidate's point also lies on a nearer triangle. The point is then no local minimum of the
// distance. The test needs no adjacency of triangles, so any polygon soup works.
bool ClosestSurface::nearest_around(std::size_t candidate) const {
  const NearTriangle& c = near_[candidate];
  for (std::size_t i = 0; i < candidate && near_[i].distance_m < c.distance_m - kTie; ++i)
    if (tree_->on_triangle(c.point, near_[i].triangle, kTie)) return false;
  return true;
}

void ClosestSurface::mesh_planes(const Vector3d& place, double reach_m, std::vector<SurfacePlane>& out) const {
  auto& triangles = near_;
  const auto nearer = [](const NearTriangle& a, const NearTriangle& b) { return a.distance_m < b.distance_m; };
  if (!tree_) return;
  tree_->near(place, reach_m, kMaxNear, triangles);
  std::sort(triangles.begin(), triangles.end(), nearer);
  // At an edge or vertex several triangles are equally near. The one that faces the query point most decides between
  // inside and outside.
  const auto facing = [&](const NearTriangle& t) { return std::abs((place - t.point).dot(t.face_normal)); };
  for (std::size_t i = 1; i < triangles.size() && triangles[i].distance_m < triangles[0].distance_m + kTie; ++i)
    if (facing(triangles[i]) > facing(triangles[0])) std::swap(triangles[0], triangles[i]);
  for (std::size_t i = 0; i < triangles.size() && static_cast<int>(out.size()) < kMaxPlanes; ++i) {
    const NearTriangle& t = triangles[i];
    // Outside, the normal points to the query point, so it is smooth across edges. Inside, it is the face normal.
    const bool outside = (place - t.point).dot(t.face_normal) >= 0;
    const Vector3d normal = outside ? unit_or(place - t.point, t.face_normal) : t.face_normal;
    // Inside, only the nearest face is meaningful.
    if (!outside && i > 0) continue;
    const bool separate = std::all_of(out.begin(), out.end(), [&](const SurfacePlane& kept) {
      return kept.normal.dot(normal) < same_direction_ && (kept.point - t.point).dot(normal) >= -kBehind &&
             (t.point - kept.point).dot(kept.normal) >= -kBehind;
    });
    if (separate && nearest_around(i)) out.push_back({t.point, normal, outside ? t.distance_m : -t.distance_m, tree_->number(t.triangle)});
  }
}

}  // namespace tactus::sim
