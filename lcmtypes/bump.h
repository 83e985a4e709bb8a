// Surface relief: maps a point of a surface to the height map of its material. Defined here once for all
// modalities, so that haptics and vision agree on the place of a groove; docs/scene_format.md describes it.
#pragma once

#include <Eigen/Core>

namespace tactus {

// Range of the extent of one repetition and of the height of a relief, m. Design: the ridges of a fingertip are 0.5
// mm apart and it feels steps of about a micrometre, with margin below; features higher than 0.1 m belong to the
// shape.
inline constexpr double kMinBumpSize_m = 1e-4, kMaxBumpSize_m = 100;
inline constexpr double kMinBumpHeight_m = 1e-7, kMaxBumpHeight_m = 0.1;

// Largest factor of a friction map. Design: from ice (0.02 to 0.05) to rubber (about 1) friction grows about
// twentyfold.
inline constexpr double kMaxFrictionFactor = 20;

// Axes of the body frame, 0 .. 2: the one nearest to a normal, and those along which u and v grow.
struct BumpAxes {
  int across = 2, u = 0, v = 1;
};

// Projection along the dominant axis of the normal, which is in the body frame: z -> (x, y), x -> (y, z), y -> (z,
// x). Ties prefer z over x over y. shaders/shade.glsl does the same.
inline BumpAxes bump_axes(const Eigen::Vector3d& normal_body) {
  const Eigen::Vector3d n = normal_body.cwiseAbs();
  const int across = n.z() >= n.x() && n.z() >= n.y() ? 2 : n.x() >= n.y() ? 0 : 1;
  return {across, (across + 1) % 3, (across + 2) % 3};
}

// Place of a point of the body frame in the map, in repetitions; drop the integer part. u grows to the right of the
// picture and v upwards; its lower left corner is at (0, 0), so the centre of pixel i is at (i + 1/2) / columns.
// size_m: of one repetition.
inline Eigen::Vector2d bump_at(const Eigen::Vector2f& size_m, const BumpAxes& axes, const Eigen::Vector3d& point_body_m) {
  return Eigen::Vector2d(point_body_m[axes.u], point_body_m[axes.v]).cwiseQuotient(size_m.cast<double>());
}

}  // namespace tactus
