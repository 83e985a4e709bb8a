// Where a surface near the tool wears the maps of its material, and what they say at the place that is touched.
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
  std::int32_t material = -1;  // -1: it wears no map
  // A point of the surface and the outward normal in its body, and how the body is turned now.
  Eigen::Vector3d point_body = Eigen::Vector3d::Zero(), normal_body = Eigen::Vector3d::UnitZ();
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();  // body to world
  double friction_static = 0, friction_dynamic = 0;    // of the pair, without a map

  // What is felt of the maps, from tick to tick; set by Reliefs.
  bool known = false, jumped = false;
  BumpAxes axes;
  Eigen::Vector2d at{0, 0};                                  // in repetitions of the relief
  const Relief* raised_by = nullptr;                         // whose height is felt
  Eigen::Vector3d looked_at_body = Eigen::Vector3d::Zero();  // where it was looked up, m
  double map_height_m = 0;                                   // there, no steeper than is felt
  double height_m = 0;                                       // felt
  Eigen::Vector3d lean = Eigen::Vector3d::Zero();            // world: the direction of the force less the normal
  double height_lag_m = 0;                                   // what is left of a jump, and goes to zero
  double height_lag_speed_m_s = 0;                           // at this speed
  Eigen::Vector3d lean_lag = Eigen::Vector3d::Zero();

  // Of a plane that has just been told; normal: as it was told, world, unit.
  void take(const touch_plane_t& plane, const Eigen::Vector3d& normal) {
    const Eigen::Vector3d u = to_eigen(plane.bump_u), n = to_eigen(plane.normal_body);
    const Eigen::Vector3d across = u - u.dot(normal) * normal;
    // A normal of no direction, or an axis along it, is of no body: then the surface is smooth.
    if (plane.material < 0 || n.norm() < 0.5 || across.norm() < 1e-3) {
      material = -1;
      return;
    }
    material = plane.material;
    point_body = to_eigen(plane.point_body_m);
    normal_body = n.normalized();
    friction_static = static_cast<double>(plane.friction_static);
    friction_dynamic = static_cast<double>(std::min(plane.friction_dynamic, plane.friction_static));
    told_ =
        frame(normal, across) * frame(normal_body, Eigen::Vector3d::Unit(bump_axes(normal_body).u)).transpose();
  }
  // turned: what the body has turned since then.
  void move(const Eigen::Matrix3d& turned) { turn = turned * told_; }

 private:
  // Two directions and the one across both.
  static Eigen::Matrix3d frame(const Eigen::Vector3d& normal, const Eigen::Vector3d& towards) {
    const Eigen::Vector3d x = (towards - towards.dot(normal) * normal).normalized();
    Eigen::Matrix3d m;
    m << x, normal.cross(x), normal;
    return m;
  }
  Eigen::Matrix3d told_ = Eigen::Matrix3d::Identity();
};

}  // namespace tactus::haptic
