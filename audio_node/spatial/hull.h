// Which three of many directions surround another: the triangles of their convex hull. Pure.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace tactus::audio {

// Indices of its corners, anticlockwise as seen from outside.
using Triangle = std::array<int, 3>;

// Of points on the unit sphere. Where more than three lie in one plane it takes one of the ways to cut that into
// triangles, the same each time. Empty when all lie in one plane.
std::vector<Triangle> convex_hull(const std::vector<Eigen::Vector3d>& points);

// The part of the sphere that each direction stands for, steradian: a third of each triangle around it. A
// direction that is told twice shares it with itself. All 0 where there is no hull.
std::vector<double> solid_angles(const std::vector<Eigen::Vector3d>& directions);

}  // namespace tactus::audio
