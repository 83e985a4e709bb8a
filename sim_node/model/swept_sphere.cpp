#include "sim_node/model/swept_sphere.h"

#include <algorithm>
#include <cmath>

namespace tactus::sim {

double first_contact_time_s(const SweptSphere& a, const SweptSphere& b, double distance, double horizon_s) {
  const Eigen::Vector3d apart = b.centre_m - a.centre_m, closing = b.velocity_m_s - a.velocity_m_s;
  // |apart + closing t|^2 = distance^2
  const double c = apart.squaredNorm() - distance * distance, half_b = apart.dot(closing),
               a2 = closing.squaredNorm();
  if (c <= 0) return 0;
  const double root = half_b * half_b - a2 * c;
  if (half_b >= 0 || root < 0) return -1;
  const double when = c / (-half_b + std::sqrt(root));
  return when <= horizon_s ? when : -1;
}

double axis_distance_m(const SweptSphere& a, const SweptSphere& b, double horizon_s) {
  const Eigen::Vector3d u = a.velocity_m_s * horizon_s, v = b.velocity_m_s * horizon_s,
                        w = a.centre_m - b.centre_m;
  const double uu = u.squaredNorm(), vv = v.squaredNorm(), uv = u.dot(v), uw = u.dot(w), vw = v.dot(w);
  const double area = uu * vv - uv * uv;
  // Parameters along each path, as a share. For parallel paths any parameter of the first is valid.
  double s = area > 1e-12 * uu * vv ? std::clamp((uv * vw - uw * vv) / area, 0.0, 1.0) : 0;
  const double along = uv * s + vw;
  double t = vv > 0 ? along / vv : 0;
  if (t < 0 || t > 1) {
    t = std::clamp(t, 0.0, 1.0);
    s = uu > 0 ? std::clamp((uv * t - uw) / uu, 0.0, 1.0) : 0;
  } else if (vv <= 0) {
    s = uu > 0 ? std::clamp(-uw / uu, 0.0, 1.0) : 0;
  }
  return (w + u * s - v * t).norm();
}

Bounds bounds_of(const SweptSphere& s, double horizon_s) {
  const Eigen::Vector3d end = s.centre_m + s.velocity_m_s * horizon_s;
  const Eigen::Vector3d reach = Eigen::Vector3d::Constant(s.radius_m + s.pad_m);
  return {s.centre_m.cwiseMin(end) - reach, s.centre_m.cwiseMax(end) + reach};
}

}  // namespace tactus::sim
