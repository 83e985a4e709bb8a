#include "sim_node/collision/gaps/feature.h"

#include <cmath>

namespace tactus::sim::gaps {

using Eigen::Vector3d;

namespace {

// Thresholds of the facing feature, cosines. A cylinder shows its cap when the direction is nearer to the axis, else
// the line on its side. A triangle shows its face when seen at more than this angle from the side, else an edge.
constexpr double kCap = 0.70711, kFace = 0.2;
// A line seen along its axis within 2.6 degrees is a point. Cosine.
constexpr double kUpright = 0.999;

Feature box_face(const Vector3d& h, const Vector3d& d) {
  Eigen::Index axis = 0;
  d.cwiseAbs().maxCoeff(&axis);
  const double side = d[axis] < 0 ? -1 : 1;
  const Eigen::Index u = (axis + 1) % 3, v = (axis + 2) % 3;
  Feature f;
  f.kind = Feature::Kind::kPolygon;
  f.count = 4;
  static constexpr double kU[4] = {-1, 1, 1, -1}, kV[4] = {-1, -1, 1, 1};
  for (std::size_t i = 0; i < 4; ++i) {
    f.corners[i][axis] = side * h[axis];
    f.corners[i][u] = kU[i] * h[u];
    f.corners[i][v] = kV[i] * h[v];
  }
  f.normal = side * Vector3d::Unit(axis);
  return f;
}

Feature cap(const Vector3d& h, const Vector3d& d) {
  const double r = h.x(), z = d.z() < 0 ? -h.z() : h.z();
  Feature f;
  f.kind = Feature::Kind::kDisc;
  f.count = 4;
  f.corners = {Vector3d(r, 0, z), Vector3d(0, r, z), Vector3d(-r, 0, z), Vector3d(0, -r, z)};
  f.normal = {0, 0, d.z() < 0 ? -1.0 : 1.0};
  f.centre = {0, 0, z};
  f.radius_m = r;
  return f;
}

Feature line(const Vector3d& from, const Vector3d& to) {
  Feature f;
  f.kind = Feature::Kind::kSegment;
  f.count = 2;
  f.corners[0] = from, f.corners[1] = to;
  return f;
}

Feature point(const Vector3d& at) {
  Feature f;
  f.count = 1;
  f.corners[0] = at;
  return f;
}

Feature of_triangle(const std::array<Vector3d, 3>& t, const Vector3d& d) {
  const Vector3d across = (t[1] - t[0]).cross(t[2] - t[0]);
  const double area = across.norm();
  const Vector3d n = area > 0 ? Vector3d(across / area) : Vector3d::Zero();
  Feature f;
  if (std::abs(n.dot(d)) > kFace) {
    f.kind = Feature::Kind::kPolygon;
    f.count = 3;
    for (std::size_t i = 0; i < 3; ++i) f.corners[i] = t[i];
    f.normal = n.dot(d) < 0 ? Vector3d(-n) : n;
    return f;
  }
  std::size_t opposite_corner = 0;
  for (std::size_t i = 1; i < 3; ++i)
    if (t[i].dot(d) < t[opposite_corner].dot(d)) opposite_corner = i;
  const Vector3d &from = t[(opposite_corner + 1) % 3], &to = t[(opposite_corner + 2) % 3];
  // An edge seen along its axis has no length: its end is a point.
  const double along = (to - from).dot(d);
  if (std::abs(along) > kUpright * (to - from).norm()) return point(along > 0 ? to : from);
  return line(from, to);
}

Feature local(const Convex& c, const Vector3d& d) {
  switch (c.core) {
    case Core::kBox: return box_face(c.half_m, d);
    case Core::kSegment:
      if (std::abs(d.z()) > kUpright) return point({0, 0, d.z() < 0 ? -c.half_m.z() : c.half_m.z()});
      return line({0, 0, -c.half_m.z()}, {0, 0, c.half_m.z()});
    case Core::kTriangle: return of_triangle(c.corners_m, d);
    case Core::kCylinder: {
      if (std::abs(d.z()) > kCap) return cap(c.half_m, d);
      const double k = c.half_m.x() / std::hypot(d.x(), d.y());
      return line({k * d.x(), k * d.y(), -c.half_m.z()}, {k * d.x(), k * d.y(), c.half_m.z()});
    }
    case Core::kPoint: break;
  }
  return point({0, 0, 0});
}

}  // namespace

Feature feature_along(const Convex& c, const Eigen::Isometry3d& to, const Vector3d& along) {
  Feature f = local(c, to.linear().transpose() * along);
  for (int i = 0; i < f.count; ++i) {
    Vector3d& corner = f.corners[static_cast<std::size_t>(i)];
    corner = to * corner;
  }
  f.normal = to.linear() * f.normal;
  f.centre = to * f.centre;
  return f;
}

}  // namespace tactus::sim::gaps
