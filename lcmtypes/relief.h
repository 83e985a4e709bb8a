// Surface relief: height, slope and normal at any place of its map. Shared by all modalities, so that the felt
// slope equals the visible one. Pure.
#pragma once

#include <Eigen/Core>
#include <tactus/material_def_t.hpp>
#include <vector>

#include "lcmtypes/bump.h"
#include "lcmtypes/height_map.h"

namespace tactus {

// A place of a map between four pixel centres; the map repeats, so its edges are neighbours.
struct Texel {
  int left, right, below, above;
  double along_u, along_v;  // share of the way from left to right and from below to above, 0 .. 1
};

// at: in repetitions, as from bump_at. Equals the GPU's GL_LINEAR with GL_REPEAT.
Texel texel_at(const Eigen::Vector2d& at, int columns, int rows);

// One repetition of a relief.
struct Relief {
  Eigen::Vector2f size_m{1, 1};  // along u and v
  int columns = 0, rows = 0;
  std::vector<float> heights_m;         // at the pixel centres, the lowest row first
  std::vector<Eigen::Vector2f> slopes;  // dh/du, dh/dv there, m/m: the content of the slope texture

  // Slope, m/m, bilinear between pixel centres: continuous. at: in repetitions. Realtime-safe: yes.
  Eigen::Vector2d slope(const Eigen::Vector2d& at) const;
  // Height above black, m. The smooth surface that matches these slopes: for a relief that varies along one axis,
  // slope() is exactly its derivative. It is a spline of second order through the means of neighbours, so a
  // single pixel appears half as high. Realtime-safe: yes.
  double height_m(const Eigen::Vector2d& at) const;
};

// Slopes are central differences, limited to 100: 89.4 degrees, which looks like a vertical wall. Design: lighting
// needs no finer difference.
Relief make_relief(const HeightMap& map, const material_def_t& material);

// Outward unit normal, body frame, of a surface with this smooth outward normal and this slope of its relief:
// subtracts the gradient of the height along the surface (Blinn 1978, "Simulation of Wrinkled Surfaces").
// shaders/shade.glsl does the same.
Eigen::Vector3d relief_normal(const Eigen::Vector3d& normal_body, const Eigen::Vector2d& slope);

}  // namespace tactus
