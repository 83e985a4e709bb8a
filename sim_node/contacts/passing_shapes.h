// Shapes that pass by each other: their nearest corners approach, but along another direction they stay apart. The solver
// extends each contact to a plane through its nearest points, which such a body would strike: a box that slides from one
// board to the next of the same height, or that flies closely over an edge.
#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <vector>

#include "sim_node/collision/gaps/convex.h"
#include "sim_node/model/body_motion.h"
#include "sim_node/model/manifold.h"
#include "sim_node/model/world_def.h"

namespace tactus::sim {

class PassingShapes {
 public:
  // tolerance_m: the largest gap at which bodies rest on each other.
  PassingShapes(const WorldDef& world, double tolerance_m);

  // Replaces the normals of a manifold whose shapes approach along them, but stay apart during the step along a direction at a
  // right angle to their relative velocity: by that direction, with the gap along it. pose_a, pose_b: of the shapes, world.
  // Motions: of their bodies at the start of the step. Planes and heightfields keep their normals. Real-time safe: yes. Pure.
  void turn_normals(Manifold& m, const Eigen::Isometry3d& pose_a, const BodyMotion& a, const Eigen::Isometry3d& pose_b, const BodyMotion& b,
                    double h_s) const;

 private:
  struct Hull {
    gaps::Convex convex;
    std::shared_ptr<const std::vector<Eigen::Vector3d>> vertices;  // of a mesh; null: convex
    bool is_bounded = true, is_static = false, is_round = false;
  };
  // Pose and velocity of a shape; a static one does not move, and the motion of its body is not read.
  Eigen::Isometry3d pose_after(int shape, const Eigen::Isometry3d& pose, const BodyMotion& m, double h_s) const;
  // That of a round shape is at its centre: its rotation moves no point of contact.
  Eigen::Vector3d velocity_m_s(int shape, const Eigen::Isometry3d& pose, const BodyMotion& m, const Eigen::Vector3d& point_m) const;
  // The point of a shape that is furthest along a direction, where a round shape touches a plane; other points stay.
  Eigen::Vector3d touching(int shape, const Eigen::Isometry3d& pose, const Eigen::Vector3d& along, const Eigen::Vector3d& point_m) const;
  // The furthest extent of a shape along a world direction, m.
  double extent_m(int shape, const Eigen::Isometry3d& pose, const Eigen::Vector3d& along) const;

  double tolerance_m_;
  std::vector<Hull> hulls_;  // per shape
};

}  // namespace tactus::sim
