// The proxy of a rigid tool: its image, with position and orientation, that stays on the surfaces while the device
// may be anywhere (Ortega, Redon and Coquillart 2007). It is the allowed pose of least coupling energy 1/2 k (|x -
// x_d|^2 + lever^2 |theta|^2), where each tool point that may meet a surface stays outside of it. The contact
// forces hold it there, so the wrench on the hand is exactly their sum.
//
// The condition is linear in a small motion from the current pose; a few iterations follow the rotation. Friction
// pulls each contact back to the place where it held, within its cone (proxy.h), contact by contact, in the
// directions that the binding surfaces leave free. The proxy never passes through a surface: a motion is cut short
// where the touch model ends.
#pragma once

#include <Eigen/Geometry>
#include <span>

#include "haptic_node/contact/pose_qp.h"
#include "haptic_node/contact/surfaces.h"

namespace tactus::haptic {

struct DevicePose {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
};

class RigidProxy {
 public:
  // lever_m: a rotation by an angle costs as much as a translation of lever times angle; above 0. bound_m: radius
  // of the tool about its centre. tool_radius_m: of a ball, the distance from its centre at which it meets
  // surfaces; otherwise 0.
  RigidProxy(double lever_m, double bound_m, double tool_radius_m)
      : lever_m_(lever_m), bound_m_(bound_m), tool_radius_m_(tool_radius_m) {}

  // Sets its pose, without friction.
  void reset(const DevicePose& at);

  // One tick: sets the depth and the friction state of every surface. The offsets hold for the orientation of the
  // proxy. No point of the tool moves further than may_move_m. Realtime-safe: yes.
  void step(std::span<Surface> surfaces, const DevicePose& device, double dt, double may_move_m);

  const Eigen::Vector3d& position() const { return pose_.position; }
  const Eigen::Quaterniond& orientation() const { return pose_.orientation; }
  const Eigen::Vector3d& velocity() const { return velocity_; }  // m/s, mean over the tick
  const Eigen::Vector3d& spin() const { return spin_; }          // rad/s
  // Upper bound of the motion of a tool point in the last tick, m.
  double moved_m() const { return moved_m_; }
  const BindingSet& binding() const { return binding_; }
  // Rate of each depth at the given velocities of device and surfaces, m/s: the rate that each surface damps.
  void depth_rates(std::span<const Surface> surfaces, const Eigen::Vector3d& velocity, const Eigen::Vector3d& spin,
                   std::span<double> rates) const;
  bool feasible() const { return feasible_; }
  // From the centre of the tool to its contact with that surface, m, world.
  Eigen::Vector3d arm(const Surface& s) const {
    return pose_.orientation * s.tool_point - tool_radius_m_ * s.normal;
  }
  double lever_m() const { return lever_m_; }

 private:
  struct Rows;
  void linearise(std::span<const Surface> surfaces, const DevicePose& start, Rows& rows) const;
  void solve_friction(std::span<Surface> surfaces, const DevicePose& start, const Rows& rows,
                      const ClosestPose& closest, double dt);
  static void set_depths(std::span<Surface> surfaces, const Rows& rows, const Vector6& goal, ClosestPose& closest);
  double move(const DevicePose& start, const Vector6& motion, double may_move_m);

  double lever_m_, bound_m_, tool_radius_m_;
  DevicePose pose_;
  Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero(), spin_ = Eigen::Vector3d::Zero();
  double moved_m_ = 0;
  BindingSet binding_;
  bool feasible_ = true;
};

}  // namespace tactus::haptic
