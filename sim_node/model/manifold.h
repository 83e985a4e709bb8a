// What a collision query finds for one pair of shapes: up to four points that stand for the whole contact.
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
  double normal_force_N = 0;                          // once solved, mean over the step
  double friction = 1;                                // factor on that of the pair, by the maps of its surfaces
};

// What a step did at a pair of shapes: how they met in it, if they did.
struct Impact {
  int blows = 0;                   // 0: they touched before, or did not touch, and the rest says nothing
  double first_s = 0, last_s = 0;  // instants of the first and the last blow, from the start of the step
  double speed_m_s = 0;            // at which the surfaces closed before the first
  double effective_mass_kg = 0;    // that it felt, joints included
  Eigen::Vector3d place_m = Eigen::Vector3d::Zero();  // of the first, world
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  // unit, world, from a to b
  // The places that met, in the frames of the bodies as they lay when the step began (its last part, if it was
  // divided). Of an impulse world: from their centres of mass, turned as since its start (impulse/body_frames.h).
  Eigen::Vector3d a_body_m = Eigen::Vector3d::Zero(), b_body_m = Eigen::Vector3d::Zero();
  int triangle_a = -1, triangle_b = -1;
};

inline constexpr int kMaxManifoldPoints = 4;

struct Manifold {
  int shape_a = -1, shape_b = -1;
  int body_a = -1, body_b = -1;  // body_a < body_b
  int count = 0;
  std::array<ManifoldPoint, kMaxManifoldPoints> points;
  Impact impact;  // once solved

  // Only what is used is copied: lists of manifolds are most of what a step moves about.
  Manifold() = default;
  Manifold(const Manifold& o) { *this = o; }
  Manifold& operator=(const Manifold& o) {
    shape_a = o.shape_a, shape_b = o.shape_b, body_a = o.body_a, body_b = o.body_b, count = o.count;
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) points[i] = o.points[i];
    if (o.impact.blows > 0)
      impact = o.impact;
    else
      impact.blows = 0;
    return *this;
  }

  std::span<const ManifoldPoint> used() const { return {points.data(), static_cast<std::size_t>(count)}; }
  std::span<ManifoldPoint> used() { return {points.data(), static_cast<std::size_t>(count)}; }
  bool before(const Manifold& o) const { return shape_a != o.shape_a ? shape_a < o.shape_a : shape_b < o.shape_b; }
};

// The deepest point, then each time the one furthest from those chosen: the corners of the patch. Without this the
// stiffness of a contact would grow with its tessellation. Fills out.points and out.count.
void reduce_points(std::span<const ManifoldPoint> found, Manifold& out);

}  // namespace tactus::sim
