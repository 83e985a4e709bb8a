// Triangulation of directions by their convex hull, to find the three that surround another. Pure.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace tactus::audio {

// Indices of its corners, anticlockwise as seen from outside.
using Triangle = std::array<int, 3>;

// Convex hull of points on the unit sphere. More than three coplanar points are divided into triangles in one
// fixed way. Empty when all are coplanar.
std::vector<Triangle> convex_hull(const std::vector<Eigen::Vector3d>& points);

// The part of the sphere that each direction represents, steradian: a third of each adjacent triangle. Duplicate
// directions share their part. All 0 without a hull.
std::vector<double> solid_angles(const std::vector<Eigen::Vector3d>& directions);

}  // namespace tactus::audio
