#include "sim_node/scene/sdf/pose.h"

#include <cmath>

namespace tactus::sim::sdf {
namespace {

constexpr double kZeroNorm = 1e-6;  // of libignition-math: a smaller norm counts as 0

// q v q^-1, with v as a quaternion without real part.
Eigen::Vector3d turned(const Rotation& q, const Eigen::Vector3d& v) {
  const Rotation r = q * (Rotation{0, v.x(), v.y(), v.z()} * q.inverse());
  return {r.x, r.y, r.z};
}

}  // namespace

Rotation Rotation::from_euler(double roll, double pitch, double yaw) {
  const double phi = roll / 2, the = pitch / 2, psi = yaw / 2;
  Rotation q{std::cos(phi) * std::cos(the) * std::cos(psi) + std::sin(phi) * std::sin(the) * std::sin(psi),
             std::sin(phi) * std::cos(the) * std::cos(psi) - std::cos(phi) * std::sin(the) * std::sin(psi),
             std::cos(phi) * std::sin(the) * std::cos(psi) + std::sin(phi) * std::cos(the) * std::sin(psi),
             std::cos(phi) * std::cos(the) * std::sin(psi) - std::sin(phi) * std::sin(the) * std::cos(psi)};
  const double norm = std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  if (norm <= kZeroNorm) return {};
  q.w /= norm, q.x /= norm, q.y /= norm, q.z /= norm;
  return q;
}

Rotation Rotation::operator*(const Rotation& q) const {
  return {w * q.w - x * q.x - y * q.y - z * q.z, w * q.x + x * q.w + y * q.z - z * q.y,
          w * q.y - x * q.z + y * q.w + z * q.x, w * q.z + x * q.y - y * q.x + z * q.w};
}

Rotation Rotation::inverse() const {
  const double s = w * w + x * x + y * y + z * z;
  if (s <= kZeroNorm) return {};
  return {w / s, -x / s, -y / s, -z / s};
}

Eigen::Vector3d Rotation::operator*(const Eigen::Vector3d& v) const {
  const Eigen::Vector3d axis(x, y, z);
  Eigen::Vector3d uv = axis.cross(v);
  Eigen::Vector3d uuv = axis.cross(uv);
  uv *= 2 * w;
  uuv *= 2;
  return v + uv + uuv;
}

Pose Pose::operator*(const Pose& other) const {
  return {position_m + turned(rotation, other.position_m), rotation * other.rotation};
}

Pose Pose::inverse() const {
  const Rotation back = rotation.inverse();
  return {back * Eigen::Vector3d(-position_m), back};
}

Eigen::Isometry3d Pose::to_eigen() const {
  return Eigen::Translation3d(position_m) *
         Eigen::Quaterniond(rotation.w, rotation.x, rotation.y, rotation.z).normalized();
}

}  // namespace tactus::sim::sdf
