// The place of a touched surface in the maps of its material, and the map values there.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdint>
#include <tactus/touch_plane_t.hpp>

#include "lcmtypes/bump.h"
#include "lcmtypes/relief.h"
#include "lcmtypes/vectors.h"

namespace tactus::haptic {

struct MappedPlace {
  std::int32_t material = -1;  // -1: no map
  // A point of the surface and its outward normal, in the frame of the body.
  Eigen::Vector3d point_body = Eigen::Vector3d::Zero(), normal_body = Eigen::Vector3d::UnitZ();
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();  // current rotation, body to world
  double friction_static = 0, friction_dynamic = 0;    // of the material pair, without a map

  // Map values in use, kept between ticks; set by Reliefs.
  bool initialised = false, jumped = false;
  BumpAxes axes;
  Eigen::Vector2d relief_uv{0, 0};                             // in repetitions of the relief
  const Relief* height_relief = nullptr;                       // relief whose height is in use
  Eigen::Vector3d last_lookup_body = Eigen::Vector3d::Zero();  // place of the last lookup, m
  double map_height_m = 0;                                   // height there, limited in slope
  double height_m = 0;                                       // as rendered
  double height_change_m = 0;                                // of height_m, in this tick
  Eigen::Vector3d force_tilt = Eigen::Vector3d::Zero();      // world: direction of the force minus the normal
  double height_lag_m = 0;                                   // remaining part of a jump; decays to zero
  double height_lag_speed_m_s = 0;                           // speed of the decay
  Eigen::Vector3d force_tilt_lag = Eigen::Vector3d::Zero();

  // Reads a plane that has just arrived; normal: as received, world, unit.
  void set_plane(const touch_plane_t& plane, const Eigen::Vector3d& normal) {
    const Eigen::Vector3d u = to_eigen(plane.bump_u), n = to_eigen(plane.normal_body);
    const Eigen::Vector3d across = u - u.dot(normal) * normal;
    // The plane belongs to no body if its normal has no direction or the axis is parallel to it: the surface is
    // then smooth.
    if (plane.material < 0 || n.norm() < 0.5 || across.norm() < 1e-3) {
      material = -1;
      return;
    }
    material = plane.material;
    point_body = to_eigen(plane.point_body_m);
    normal_body = n.normalized();
    friction_static = static_cast<double>(plane.friction_static);
    friction_dynamic = static_cast<double>(std::min(plane.friction_dynamic, plane.friction_static));
    published_rotation_ =
        frame(normal, across) * frame(normal_body, Eigen::Vector3d::Unit(bump_axes(normal_body).u)).transpose();
  }
  // by: rotation of the body since the plane arrived.
  void rotate(const Eigen::Matrix3d& by) { rotation = by * published_rotation_; }

 private:
  // Frame of the normal, the tangent direction and their cross product.
  static Eigen::Matrix3d frame(const Eigen::Vector3d& normal, const Eigen::Vector3d& towards) {
    const Eigen::Vector3d x = (towards - towards.dot(normal) * normal).normalized();
    Eigen::Matrix3d m;
    m << x, normal.cross(x), normal;
    return m;
  }
  Eigen::Matrix3d published_rotation_ = Eigen::Matrix3d::Identity();
};

}  // namespace tactus::haptic
