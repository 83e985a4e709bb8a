// A tree of links, as it is given and as the dynamics needs it: each link hangs on its parent, or on the world, by
// one joint. Plain data, SI. At rest, where every joint stands at zero, all axes are the world's: a link's turn is
// what it has turned since.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "sim_node/model/world_def.h"

namespace tactus::sim::articulated {

inline constexpr int kMaxDofs = 3;  // of a joint; a free base has six of its own

struct LinkDef {
  int parent = -1;       // an earlier link; -1: the world
  bool is_free = false;  // the first link only: it hangs on nothing
  JointKind joint = JointKind::kRevolute;
  Eigen::Vector3d anchor_m = Eigen::Vector3d::Zero();  // world, at rest
  JointAxis axes[2];  // a universal's first belongs to the parent; a ball takes damping and friction of the first
  double mass_kg = 1;
  Eigen::Vector3d centre_m = Eigen::Vector3d::Zero();           // world, at rest
  Eigen::Matrix3d inertia_kg_m2 = Eigen::Matrix3d::Identity();  // about the centre, world axes, at rest
  Eigen::Vector3d gravity_m_s2 = Eigen::Vector3d::Zero();
  double linear_damping_1_s = 0, angular_damping_1_s = 0;
};

// Degrees of freedom of a joint, and the numbers that its position takes (four of a quaternion for a ball).
int dofs_of(const LinkDef& link);
int coordinates_of(const LinkDef& link);

// What acts along one degree of freedom. kind of the coordinate: an angle, rad, or a length, m.
struct Dof {
  int link = -1;
  int coordinate = -1;  // of the position; -1: the dof of a ball or a free base has no number of its own
  double damping = 0, stiffness = 0, reference = 0;
  double friction = 0, lower = -1e16, upper = 1e16, motor_velocity = 0, motor_effort = 0;
};

struct Link {
  LinkDef def;
  int first_dof = 0, dofs = 0;
  int first_coordinate = 0;
  Eigen::Vector3d from_parent_m, to_centre_m;  // parent's centre (or the origin) to anchor to own centre, at rest
};

struct Tree {
  std::vector<Link> links;
  std::vector<Dof> dofs;
  int coordinates = 0;

  // Throws std::invalid_argument when a parent does not come before its child or a mass or inertia is not
  // positive.
  explicit Tree(const std::vector<LinkDef>& links);
  int dof_count() const { return static_cast<int>(dofs.size()); }
};

}  // namespace tactus::sim::articulated
