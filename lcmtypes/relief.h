// How high and how steep a relief is at any place of its map, and which way its surface faces there: for every
// sense the same, so that the hand feels the slope on which an eye sees the light. Pure.
#pragma once

#include <Eigen/Core>
#include <tactus/material_def_t.hpp>
#include <vector>

#include "lcmtypes/bump.h"
#include "lcmtypes/height_map.h"

namespace tactus {

// Where a place of a map lies between the middles of four pixels; the map repeats, so its edges are neighbours.
struct Texel {
  int left, right, below, above;
  double along_u, along_v;  // share of the way from left to right and from below to above, 0 .. 1
};

// at: in repetitions, as bump_at says. As the GPU's GL_LINEAR with GL_REPEAT.
Texel texel_at(const Eigen::Vector2d& at, int columns, int rows);

// One repetition of a relief.
struct Relief {
  Eigen::Vector2f size_m{1, 1};  // along u and v
  int columns = 0, rows = 0;
  std::vector<float> heights_m;         // at the middle of each pixel, the lowest row first
  std::vector<Eigen::Vector2f> slopes;  // dh/du, dh/dv there, m/m: what a picture's texture holds

  // m/m, linear between the middles of the pixels: continuous. at: in repetitions. Realtime-safe: yes.
  Eigen::Vector2d slope(const Eigen::Vector2d& at) const;
  // m over black. The smooth surface that belongs to these slopes: of a relief that varies along one axis slope()
  // is its derivative exactly. It is a spline of second order through the means of neighbours, so one pixel alone
  // stands out half as high. Realtime-safe: yes.
  double height_m(const Eigen::Vector2d& at) const;
};

// Slopes are central differences and at most 100: 89.4 degrees, a step that looks like a wall. Design: light needs
// no finer difference.
Relief make_relief(const HeightMap& map, const material_def_t& material);

// Outward unit normal, body frame, of a surface of that smooth outward normal where its relief has that slope: the
// height's gradient along the surface is taken off it (Blinn 1978, "Simulation of Wrinkled Surfaces").
// shaders/surface.frag does the same.
Eigen::Vector3d relief_normal(const Eigen::Vector3d& normal_body, const Eigen::Vector2d& slope);

}  // namespace tactus
