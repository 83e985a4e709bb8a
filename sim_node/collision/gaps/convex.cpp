#include "sim_node/collision/gaps/convex.h"

#include <cmath>

namespace tactus::sim::gaps {
namespace {

// Thickness of the plate that represents a moving plane, m. The same as in ode_geoms.cpp.
constexpr double kPlate_m = 0.01;

}  // namespace

Convex convex_of(const ShapeDef& shape) {
  const Eigen::Vector3d& s = shape.size_m;
  switch (shape.kind) {
    case ShapeKind::kBox: return {Core::kBox, s / 2, 0, {}};
    case ShapeKind::kCapsule: return {Core::kSegment, {0, 0, s.z() / 2}, s.x(), {}};
    case ShapeKind::kCylinder: return {Core::kCylinder, {s.x(), s.x(), s.z() / 2}, 0, {}};
    case ShapeKind::kPlane: return {Core::kBox, {s.x() / 2, s.y() / 2, kPlate_m / 2}, 0, {}};
    default: return {Core::kPoint, {0, 0, 0}, s.x(), {}};
  }
}

Eigen::Isometry3d plate_offset() { return Eigen::Isometry3d(Eigen::Translation3d(0, 0, -kPlate_m / 2)); }

Convex shrunk(const Convex& c, double by_m) {
  Convex out = c;
  if (c.core == Core::kBox || c.core == Core::kCylinder) out.half_m = (c.half_m.array() - by_m).max(0);
  return out;
}

double bound_m(const Convex& c) {
  if (c.core == Core::kCylinder) return std::hypot(c.half_m.x(), c.half_m.z());
  return c.half_m.norm() + c.round_m;
}

}  // namespace tactus::sim::gaps
