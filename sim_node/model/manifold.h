// Contact manifold: result of a collision query for one pair of shapes, with up to four points for each direction in
// which their surfaces face each other, of up to three directions.
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>

namespace tactus::sim {

struct ManifoldPoint {
  Eigen::Vector3d point_m = Eigen::Vector3d::Zero();  // world, between the surfaces or on one of them
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  // unit, world, from a to b
  double depth_m = 0;                                 // positive inside; negative: a gap
  int triangle_a = -1, triangle_b = -1;               // of a mesh; -1: none
  double normal_force_N = 0;                          // output of the solver, mean over the step
  double friction = 1;                                // factor on the friction of the pair, from friction maps
};

// Impacts of a pair of shapes within a step, as the solver reports them: the fastest one, and their number.
struct Impact {
  int count = 0;                   // 0: no impact within the step; the other members are then undefined
  double first_s = 0, last_s = 0;  // times of the fastest and the last impact, from the start of the step
  double speed_m_s = 0;            // closing speed before the fastest impact
  double effective_mass_kg = 0;    // at the fastest impact, joints included
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();  // of the fastest impact, world
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  // unit, world, from a to b
  // Positions of the fastest impact in the frames of the bodies at the start of the step (of its last part, if it was
  // divided). In an impulse world: from the centres of mass, with the rotation since the start
  // (impulse/body_frames.h).
  Eigen::Vector3d a_body_m = Eigen::Vector3d::Zero(), b_body_m = Eigen::Vector3d::Zero();
  int triangle_a = -1, triangle_b = -1;
};

inline constexpr int kMaxFacePoints = 4, kMaxFaces = 3;
inline constexpr int kMaxManifoldPoints = kMaxFacePoints * kMaxFaces;

struct Manifold {
  int shape_a = -1, shape_b = -1;
  int body_a = -1, body_b = -1;  // body_a < body_b
  int count = 0;
  std::array<ManifoldPoint, kMaxManifoldPoints> points;
  Impact impact;  // output of the solver

  // Copies only the points in use, since lists of manifolds are most of the data that a step moves.
  Manifold() = default;
  Manifold(const Manifold& o) { *this = o; }
  Manifold& operator=(const Manifold& o) {
    shape_a = o.shape_a, shape_b = o.shape_b, body_a = o.body_a, body_b = o.body_b, count = o.count;
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) points[i] = o.points[i];
    if (o.impact.count > 0)
      impact = o.impact;
    else
      impact.count = 0;
    return *this;
  }

  std::span<const ManifoldPoint> used() const { return {points.data(), static_cast<std::size_t>(count)}; }
  std::span<ManifoldPoint> used() { return {points.data(), static_cast<std::size_t>(count)}; }
  bool before(const Manifold& o) const { return shape_a != o.shape_a ? shape_a < o.shape_a : shape_b < o.shape_b; }
};

// Selects the deepest point, then repeatedly the one furthest from those selected: the corners of the patch. Without
// this reduction the stiffness of a contact would depend on its tessellation. Fills out.points and out.count with at
// most kMaxFacePoints.
void reduce_points(std::span<const ManifoldPoint> found, Manifold& out);

}  // namespace tactus::sim
