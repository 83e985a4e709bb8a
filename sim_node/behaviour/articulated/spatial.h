// Spatial vectors and inertias (Featherstone 2008, "Rigid Body Dynamics Algorithms", chapter 2). All of one system
// are in world axes about one common point, so that no transforms between links are needed.
#pragma once

#include <Eigen/Geometry>

namespace tactus::sim::articulated {

// Motion: angular part first, then linear at the common point. Force: moment about the common point first, then
// force.
using Spatial = Eigen::Matrix<double, 6, 1>;
using SpatialInertia = Eigen::Matrix<double, 6, 6>;

inline Spatial spatial(const Eigen::Vector3d& top, const Eigen::Vector3d& bottom) {
  Spatial out;
  out << top, bottom;
  return out;
}

// v x m, equation 2.31: rate of a motion vector m that moves with v.
inline Spatial cross_motion(const Spatial& v, const Spatial& m) {
  const Eigen::Vector3d w = v.head<3>(), l = v.tail<3>(), mw = m.head<3>(), ml = m.tail<3>();
  return spatial(w.cross(mw), w.cross(ml) + l.cross(mw));
}

// v x* f, equation 2.32: the same for a force vector.
inline Spatial cross_force(const Spatial& v, const Spatial& f) {
  const Eigen::Vector3d w = v.head<3>(), l = v.tail<3>(), n = f.head<3>(), p = f.tail<3>();
  return spatial(w.cross(n) + l.cross(p), w.cross(p));
}

inline Eigen::Matrix3d skew(const Eigen::Vector3d& a) {
  Eigen::Matrix3d out;
  out << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return out;
}

// Equation 2.63. mass, kg; centre c, m; inertia about the centre, kg m^2.
inline SpatialInertia rigid_inertia(double mass_kg, const Eigen::Vector3d& c,
                                    const Eigen::Matrix3d& about_centre) {
  SpatialInertia out;
  const Eigen::Matrix3d mc = mass_kg * skew(c);
  out.topLeftCorner<3, 3>() = about_centre;
  out.topLeftCorner<3, 3>().noalias() -= mass_kg * c * c.transpose();
  out.topLeftCorner<3, 3>().diagonal().array() += mass_kg * c.squaredNorm();
  out.topRightCorner<3, 3>() = mc;
  out.bottomLeftCorner<3, 3>() = -mc;
  out.bottomRightCorner<3, 3>() = mass_kg * Eigen::Matrix3d::Identity();
  return out;
}

// Spatial force of a force at a point p, m from the common point.
inline Spatial force_at(const Eigen::Vector3d& p, const Eigen::Vector3d& force) {
  return spatial(p.cross(force), force);
}

// Rotation matrix about a unit axis (Rodrigues).
inline Eigen::Matrix3d rotation_about(const Eigen::Vector3d& axis, double angle_rad) {
  const double s = std::sin(angle_rad), c = std::cos(angle_rad), d = 1 - c;
  const double x = axis.x(), y = axis.y(), z = axis.z();
  Eigen::Matrix3d out;
  out << c + d * x * x, d * x * y - s * z, d * x * z + s * y,  //
      d * x * y + s * z, c + d * y * y, d * y * z - s * x,     //
      d * x * z - s * y, d * y * z + s * x, c + d * z * z;
  return out;
}

}  // namespace tactus::sim::articulated
