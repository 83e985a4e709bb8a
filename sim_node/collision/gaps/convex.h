// A convex shape as a core with a rounding radius, for the search for the nearest points. Pure.
#pragma once

#include <Eigen/Geometry>
#include <array>

#include "sim_node/model/world_def.h"

namespace tactus::sim::gaps {

enum class Core { kPoint, kSegment, kBox, kCylinder, kTriangle };

// In its own frame. Segments and cylinders lie along z. A sphere is a point with a radius, a capsule is a segment
// with a radius.
struct Convex {
  Core core = Core::kPoint;
  Eigen::Vector3d half_m{0, 0, 0};  // box: half extents; segment: (0, 0, half); cylinder: (radius, radius, half)
  double round_m = 0;
  std::array<Eigen::Vector3d, 3> corners_m;  // of a triangle
};

// A plane becomes the plate that represents a moving plane; see plate_offset(). Meshes and heightfields are not
// supported.
Convex convex_of(const ShapeDef& shape);
// Transform from the frame of a plane to that of its plate, with the thickness of ODE's geometry.
Eigen::Isometry3d plate_offset();

// Support point of the core: the furthest along d.
inline Eigen::Vector3d support(const Convex& c, const Eigen::Vector3d& d) {
  const auto side = [](double x, double half) { return x < 0 ? -half : half; };
  switch (c.core) {
    case Core::kPoint: return {0, 0, 0};
    case Core::kSegment: return {0, 0, side(d.z(), c.half_m.z())};
    case Core::kBox: return {side(d.x(), c.half_m.x()), side(d.y(), c.half_m.y()), side(d.z(), c.half_m.z())};
    case Core::kCylinder: {
      const double across = std::sqrt(d.x() * d.x() + d.y() * d.y());
      const double k = across > 0 ? c.half_m.x() / across : 0;
      return {k * d.x(), k * d.y(), side(d.z(), c.half_m.z())};
    }
    case Core::kTriangle: break;
  }
  const double x = d.dot(c.corners_m[0]), y = d.dot(c.corners_m[1]), z = d.dot(c.corners_m[2]);
  return x >= y && x >= z ? c.corners_m[0] : y >= z ? c.corners_m[1] : c.corners_m[2];
}

// Returns a smaller core of the same kind. Cores without volume are returned unchanged.
Convex shrunk(const Convex& c, double by_m);
// Radius of the bounding sphere around the centre of the core, rounding included.
double bound_m(const Convex& c);

}  // namespace tactus::sim::gaps
