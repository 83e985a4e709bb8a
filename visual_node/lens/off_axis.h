// Off-axis projection: the view of an eye through a wall as through a window. Pure.
#pragma once

#include <array>

#include "visual_node/lens/camera.h"
#include "visual_node/lens/wall.h"

namespace tactus::visual {

// Maps the corners of the wall to those of the picture (Kooima, "Generalized Perspective Projection", 2009). wall
// and eye: in the world frame. origin_m: origin of the picture, world. near_m and far_m: depth along the normal of the wall. An eye
// in the plane of the wall or behind it is moved to kMinEyeDistance_m before it.
Camera off_axis(const Wall& wall, const Eigen::Vector3d& eye, const Eigen::Vector3d& origin_m, int width, double near_m, double far_m);
// The same with the origin that belongs to the eye.
inline Camera off_axis(const Wall& wall, const Eigen::Vector3d& eye, int width, double near_m, double far_m) {
  return off_axis(wall, eye, drawing_origin(eye), width, near_m, far_m);
}

inline constexpr double kMinEyeDistance_m = 0.01;  // design: no eye comes closer to a screen

// head: T_world_head, x ahead, y to the left, z up. Returns the left and the right eye, eye_distance_m apart along
// the axis through both ears: a point at infinity has that same distance between the two pictures.
std::array<Eigen::Vector3d, 2> eyes(const Eigen::Isometry3d& head, double eye_distance_m);

}  // namespace tactus::visual
