// The proxy of a rigid tool: its image with position and orientation that stays on the surfaces while the device
// may be anywhere (Ortega, Redon and Coquillart 2007). It is the allowed pose of least coupling energy 1/2 k (|x -
// x_d|^2 + lever^2 |theta|^2), where each point of the tool that may meet a surface stays outside of it; what
// holds it off are the forces of the contacts, so that the wrench on the hand is shared by them without rest.
//
// The condition is linear in a small motion from where the proxy is; a few rounds follow the turn. Friction pulls
// each contact back to where it held, as far as its cone is wide (proxy.h), contact by contact, on the face that
// the binding surfaces leave free. What must not be passed is not passed: a motion is cut short where the touch
// model ends.
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
  // lever_m: turning by an angle costs as much as moving by lever times it; above 0. bound_m: of the tool around
  // its centre. tool_radius_m: of a ball, which meets surfaces so far from its centre; else 0.
  RigidProxy(double lever_m, double bound_m, double tool_radius_m)
      : lever_m_(lever_m), bound_m_(bound_m), tool_radius_m_(tool_radius_m) {}

  // Places it, without friction.
  void reset(const DevicePose& at);

  // One tick: sets depth_m, grip, owed and slips of every surface; their offsets are for the tool turned as the
  // proxy is. No point of the tool moves further than may_move_m. Realtime-safe: yes.
  void step(std::span<Surface> surfaces, const DevicePose& device, double dt, double may_move_m);

  const Eigen::Vector3d& position() const { return pose_.position; }
  const Eigen::Quaterniond& orientation() const { return pose_.orientation; }
  const Eigen::Vector3d& velocity() const { return velocity_; }  // m/s, mean over the tick
  const Eigen::Vector3d& spin() const { return spin_; }          // rad/s
  // How far a point of the tool moved in the last tick, at most, m.
  double moved_m() const { return moved_m_; }
  const BindingSet& binding() const { return binding_; }
  // How fast depths grow while device and surfaces go on as they do, m/s: what each surface is to damp.
  void depth_rates(std::span<const Surface> surfaces, const Eigen::Vector3d& velocity, const Eigen::Vector3d& spin,
                   std::span<double> rates) const;
  bool feasible() const { return feasible_; }
  // From the centre of the tool to where it meets that surface, m, world.
  Eigen::Vector3d arm(const Surface& s) const {
    return pose_.orientation * s.tool_point - tool_radius_m_ * s.normal;
  }
  double lever_m() const { return lever_m_; }

 private:
  struct Rows;
  void linearise(std::span<const Surface> surfaces, const DevicePose& start, Rows& rows) const;
  void hold(std::span<Surface> surfaces, const DevicePose& start, const Rows& rows, const ClosestPose& closest,
            double dt);
  static void press(std::span<Surface> surfaces, const Rows& rows, const Vector6& goal, ClosestPose& closest);
  double move(const DevicePose& start, const Vector6& motion, double may_move_m);

  double lever_m_, bound_m_, tool_radius_m_;
  DevicePose pose_;
  Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero(), spin_ = Eigen::Vector3d::Zero();
  double moved_m_ = 0;
  BindingSet binding_;
  bool feasible_ = true;
};

}  // namespace tactus::haptic
