// Conversions between wire vectors and Eigen.
#pragma once

#include <Eigen/Geometry>
#include <tactus/pose_t.hpp>
#include <tactus/quat_t.hpp>
#include <tactus/quatf_t.hpp>
#include <tactus/vec3_t.hpp>
#include <tactus/vec3f_t.hpp>

namespace tactus {

inline Eigen::Vector3d to_eigen(const vec3_t& v) { return {v.x, v.y, v.z}; }
inline Eigen::Vector3d to_eigen(const vec3f_t& v) { return {v.x, v.y, v.z}; }
inline Eigen::Quaterniond to_eigen(const quat_t& q) { return {q.w, q.x, q.y, q.z}; }
inline Eigen::Quaterniond to_eigen(const quatf_t& q) { return {q.w, q.x, q.y, q.z}; }
inline Eigen::Isometry3d to_eigen(const pose_t& p) {
  return Eigen::Translation3d(to_eigen(p.position_m)) * to_eigen(p.orientation).normalized();
}

inline vec3_t to_vec3(const Eigen::Vector3d& v) {
  vec3_t out{};
  out.x = v.x(), out.y = v.y(), out.z = v.z();
  return out;
}
inline vec3f_t to_vec3f(const Eigen::Vector3d& v) {
  vec3f_t out{};
  out.x = static_cast<float>(v.x()), out.y = static_cast<float>(v.y()), out.z = static_cast<float>(v.z());
  return out;
}
inline quat_t to_quat(const Eigen::Quaterniond& q) {
  quat_t out{};
  out.w = q.w(), out.x = q.x(), out.y = q.y(), out.z = q.z();
  return out;
}
inline quatf_t to_quatf(const Eigen::Quaterniond& q) {
  quatf_t out{};
  out.w = static_cast<float>(q.w()), out.x = static_cast<float>(q.x());
  out.y = static_cast<float>(q.y()), out.z = static_cast<float>(q.z());
  return out;
}
inline pose_t to_pose(const Eigen::Isometry3d& t) {
  pose_t out{};
  out.position_m = to_vec3(t.translation());
  out.orientation = to_quat(Eigen::Quaterniond(t.linear()));
  return out;
}

}  // namespace tactus
