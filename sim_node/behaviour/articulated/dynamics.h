// Forward dynamics of a tree by the articulated-body algorithm (Featherstone 2008, table 7.1), and its response to
// impulses, which uses the same factors.
#pragma once

#include <span>
#include <vector>

#include "sim_node/behaviour/articulated/spatial.h"
#include "sim_node/behaviour/articulated/tree.h"

namespace tactus::sim::articulated {

// Loads of a system, constant during a step.
struct Loads {
  std::vector<Eigen::Vector3d> force_N, moment_N_m;  // per link, world axes, at its centre
  std::vector<double> torque;                        // per dof, N m or N

  explicit Loads(const Tree& tree)
      : force_N(tree.links.size(), Eigen::Vector3d::Zero()),
        moment_N_m(tree.links.size(), Eigen::Vector3d::Zero()),
        torque(tree.dofs.size(), 0.0) {}
};

class Dynamics {
 public:
  explicit Dynamics(const Tree& tree);

  // Computes the poses and velocities of the links and the acceleration of every dof. positions: coordinates;
  // quaternions as w x y z of any length > 0. rates, accelerations: per dof. The rates of a ball joint are those of
  // the child relative to the parent in the child's axes (the world's axes at rest). The rates of a free base are its
  // angular velocity and the velocity of its centre, world axes. passive: per dof, whether its spring and damper act
  // here (stiff ones act elsewhere). Real-time safe: yes.
  void evaluate(const double* positions, const double* rates, const Loads& loads, const std::vector<char>& passive,
                double* accelerations);
  // Computes only the poses and velocities of the links.
  void place(const double* positions, const double* rates);

  // Orientation and centre of a link in the world, as last evaluated or placed.
  const Eigen::Matrix3d& rotation(int link) const { return work_[index(link)].rotation; }
  Eigen::Vector3d centre_m(int link) const { return work_[index(link)].centre + origin_; }
  Eigen::Vector3d spin_rad_s(int link) const { return work_[index(link)].velocity.head<3>(); }
  Eigen::Vector3d velocity_at(int link, const Eigen::Vector3d& point_m) const {
    const Spatial& v = work_[index(link)].velocity;
    return v.tail<3>() + v.head<3>().cross(point_m - origin_);
  }

  // The following functions need an evaluate() of the current pose. impulse_to_rates() gives the change of every
  // rate by an impulse, N s, at a point of a link: M^-1 J^T impulse. Cost: one pass over all links.
  void impulse_to_rates(int link, const Eigen::Vector3d& point_m, const Eigen::Vector3d& impulse,
                        std::span<double> rates);
  // The same for an angular impulse, N m s.
  void angular_impulse_to_rates(int link, const Eigen::Vector3d& impulse, std::span<double> rates);
  // Change of every rate by a unit impulse along one dof.
  void dof_impulse_to_rates(int dof, std::span<double> rates);
  // Change of velocity of one point per unit impulse at another, per axis: J_to M^-1 J_from^T, 1/kg. Cost: the paths
  // from both links to the root. response(a, b) is the transpose of response(b, a).
  Eigen::Matrix3d response(int to_link, const Eigen::Vector3d& to_m, int from_link, const Eigen::Vector3d& from_m);
  // Velocity of a point of a link per unit rate of each dof, 3 x dofs, row-major; zero for dofs that do not move the
  // link.
  void jacobian(int link, const Eigen::Vector3d& point_m, std::span<double> rows) const;

 private:
  struct Work {
    Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
    Eigen::Vector3d centre;                       // from the common point, m
    Eigen::Matrix<double, 6, kMaxDofs> axes;     // S: motion per unit rate of each dof
    Spatial velocity, bias;                       // v, and c: acceleration at zero joint acceleration
    SpatialInertia inertia;                       // rigid, then articulated: I^A
    Spatial force;                                // p^A
    Eigen::Matrix<double, 6, kMaxDofs> carried;  // U = I^A S
    Eigen::Matrix<double, 6, kMaxDofs> shared;   // U D^-1
    Eigen::Matrix3d inverse;                      // D^-1
    Eigen::Vector3d drive;                        // u
    Spatial acceleration = Spatial::Zero();
  };
  static std::size_t index(int i) { return static_cast<std::size_t>(i); }
  void place_link(std::size_t i, const double* positions, const double* rates);
  void load_link(std::size_t i, const Loads& loads);
  void drive_link(std::size_t i, const double* positions, const double* rates, const Loads& loads,
                  const std::vector<char>& passive);
  template <int N>
  void condense(std::size_t i);
  void condense_base();
  template <int N>
  Spatial respond(std::size_t i, const Spatial& before, const Eigen::Vector3d& drive, double* rates) const;
  Spatial respond_link(std::size_t i, const Spatial& before, const Eigen::Vector3d& drive, double* rates) const;
  void propagate_inward(int link, Spatial force);
  void propagate_outward(std::span<double> rates);

  const Tree& tree_;
  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();  // the common point: the root's anchor or free centre
  std::vector<Work> work_;
  Eigen::Matrix<double, 6, 6> base_inverse_;  // of a free base: (I^A)^-1
  // Impulse propagation: the force at each joint, then the change of each link's velocity.
  std::vector<Eigen::Vector3d> struck_;
  std::vector<Spatial> change_;
  Spatial base_struck_ = Spatial::Zero();
  std::vector<int> path_;
};

}  // namespace tactus::sim::articulated
