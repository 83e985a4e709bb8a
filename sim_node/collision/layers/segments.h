// Nearest points of two line segments.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>

namespace tactus::sim {

// Squared sine of the angle below which two segments count as parallel. The rounding of parallel edges after a
// rotation is 1e-32, and at 1e-20 the distance changes by at most 1e-10 of a length.
inline constexpr double kParallel = 1e-20;
// Squared sine (1 mrad) below which the ends of the overlap delimit a contact better than the nearest points alone.
inline constexpr double kNearlyParallel = 1e-6;

// Calls emit(point on p q, point on u v) for the nearest points, when the lines pass within the tolerance. For nearly
// parallel segments it also emits both ends of their overlap; for parallel segments only these. Emits at most three
// times. Emitted points may be further apart than the tolerance.
template <class Emit>
void nearest_on_segments(const Eigen::Vector3d& p, const Eigen::Vector3d& q, const Eigen::Vector3d& u,
                         const Eigen::Vector3d& v, double tolerance_m, Emit&& emit) {
  using Eigen::Vector3d;
  const Vector3d d = q - p, e = v - u, r = u - p, n = d.cross(e);
  const double dd = d.squaredNorm(), ee = e.squaredNorm(), nn = n.squaredNorm();
  const auto on_first = [&](const Vector3d& x) { return dd > 0 ? std::clamp(d.dot(x - p) / dd, 0.0, 1.0) : 0.0; };
  const auto on_second = [&](const Vector3d& x) { return ee > 0 ? std::clamp(e.dot(x - u) / ee, 0.0, 1.0) : 0.0; };
  if (nn > kParallel * dd * ee) {
    const double apart = r.dot(n);
    if (apart * apart > tolerance_m * tolerance_m * nn) return;
    // Determinants for the infinite lines lose less precision than the usual dot products. Then the parameters are
    // clamped one after the other (Ericson 2005, section 5.1.9).
    double s = std::clamp(r.cross(e).dot(n) / nn, 0.0, 1.0);
    const double t = e.dot(p + s * d - u) / ee;
    Vector3d on_uv = u + t * e;
    if (t < 0 || t > 1) {
      on_uv = t < 0 ? u : v;
      s = on_first(on_uv);
    }
    emit(p + s * d, on_uv);
    if (nn > kNearlyParallel * dd * ee) return;
  }
  double low = 0, high = 0;  // of the overlap, along p q
  if (dd > 0) {
    low = d.dot(u - p) / dd, high = d.dot(v - p) / dd;
    if (low > high) std::swap(low, high);
    if (low >= 1 || high <= 0)  // no overlap: the two nearest ends
      low = high = low >= 1 ? 1 : 0;
    else
      low = std::max(low, 0.0), high = std::min(high, 1.0);
  }
  for (const double s : {low, high}) {
    const Vector3d x = p + s * d;
    emit(x, u + on_second(x) * e);
    if (low == high) return;
  }
}

}  // namespace tactus::sim
