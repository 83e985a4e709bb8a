// What an eye sees through a wall as through a window, wherever it is. Pure.
#pragma once

#include <array>

#include "visual_node/lens/camera.h"
#include "visual_node/lens/wall.h"

namespace tactus::visual {

// Corners of the wall become those of the picture (Kooima, "Generalized Perspective Projection", 2009). wall and
// eye in one frame, that of the world. near_m and far_m: depth, across the wall. An eye in the plane of the wall
// or behind it sees as from kNearest_m before it.
Camera off_axis(const Wall& wall, const Eigen::Vector3d& eye, int width, double near_m, double far_m);

inline constexpr double kNearest_m = 0.01;  // design: nobody's eye comes nearer to a screen

// T_world_head, x ahead, y to the left, z up. Left and right, apart along the axis through both ears: what is
// infinitely far is as far apart in the two pictures as they are.
std::array<Eigen::Vector3d, 2> eyes(const Eigen::Isometry3d& head, double apart_m);

}  // namespace tactus::visual
