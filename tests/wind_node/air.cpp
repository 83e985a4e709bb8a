#include "tests/wind_node/air.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tactus::wind {

Eigen::Vector3d air_velocity_m_s(const Eigen::Vector3d& at, const Eigen::Vector3d& centre, double radius_m,
                                 const Eigen::Vector3d& velocity_m_s) {
  const Eigen::Vector3d away = at - centre;
  const double distance_m = away.norm();
  if (!(radius_m > 0) || !(distance_m > 0)) return Eigen::Vector3d::Zero();
  const Eigen::Vector3d e = away / distance_m;
  const double near = radius_m / std::max(radius_m, distance_m);
  return 0.5 * near * near * near * (3 * velocity_m_s.dot(e) * e - velocity_m_s);
}

double equivalent_radius_m(const shape_def_t& shape, double otherwise_m) {
  const vec3_t& s = shape.size_m;
  const double disc_m2 = std::numbers::pi * s.x * s.x;
  double volume_m3 = 0;
  switch (shape.kind) {
    case shape_def_t::BOX: volume_m3 = s.x * s.y * s.z; break;
    case shape_def_t::SPHERE: volume_m3 = 4.0 / 3 * disc_m2 * s.x; break;
    case shape_def_t::CYLINDER: volume_m3 = disc_m2 * s.z; break;
    case shape_def_t::CAPSULE: volume_m3 = disc_m2 * (s.z + 4.0 / 3 * s.x); break;
    default: return otherwise_m;
  }
  return std::cbrt(volume_m3 * 3 / (4 * std::numbers::pi));
}

}  // namespace tactus::wind
