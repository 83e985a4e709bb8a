// A tree of links, as input and as prepared for the dynamics. Each link is connected to its parent or to the world by
// one joint. Plain data, SI. At rest every joint is at zero and all axes are the world's, so a link's orientation is
// its rotation since rest.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "sim_node/model/world_def.h"

namespace tactus::sim::articulated {

inline constexpr int kMaxDofs = 3;  // per joint; a free base has six of its own

struct LinkDef {
  int parent = -1;       // index of an earlier link; -1: the world
  bool is_free = false;  // first link only: a free base
  JointKind joint = JointKind::kRevolute;
  Eigen::Vector3d anchor_m = Eigen::Vector3d::Zero();  // world, at rest
  JointAxis axes[2];  // the first axis of a universal joint belongs to the parent; a ball joint uses damping and friction of the first
  double mass_kg = 1;
  Eigen::Vector3d centre_m = Eigen::Vector3d::Zero();           // world, at rest
  Eigen::Matrix3d inertia_kg_m2 = Eigen::Matrix3d::Identity();  // about the centre, world axes, at rest
  Eigen::Vector3d gravity_m_s2 = Eigen::Vector3d::Zero();
  double linear_damping_1_s = 0, angular_damping_1_s = 0;
};

// Degrees of freedom of a joint, and the number of its coordinates (four for the quaternion of a ball joint).
int dofs_of(const LinkDef& link);
int coordinates_of(const LinkDef& link);

// One degree of freedom and its passive forces. The coordinate is an angle, rad, or a length, m.
struct Dof {
  int link = -1;
  int coordinate = -1;  // index in the positions; -1: a dof of a ball joint or a free base, without a coordinate of its own
  double damping = 0, stiffness = 0, reference = 0;
  double friction = 0, lower = -1e16, upper = 1e16, motor_velocity = 0, motor_effort = 0;
};

struct Link {
  LinkDef def;
  int first_dof = 0, dofs = 0;
  int first_coordinate = 0;
  Eigen::Vector3d from_parent_m, to_centre_m;  // at rest: parent's centre (or the origin) to anchor, and anchor to own centre
};

struct Tree {
  std::vector<Link> links;
  std::vector<Dof> dofs;
  int coordinates = 0;

  // Throws std::invalid_argument when a parent does not precede its child, or a mass or inertia is not positive.
  explicit Tree(const std::vector<LinkDef>& links);
  int dof_count() const { return static_cast<int>(dofs.size()); }
};

}  // namespace tactus::sim::articulated
