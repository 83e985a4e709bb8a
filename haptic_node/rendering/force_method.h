// The methods that make the constraint force from the surfaces near the tool. They can be switched while the hand
// is pressed. direct: a spring at the device itself. proxy: a point that stays on the surfaces, force only. rigid:
// a rigid body that stays on them, force and torque.
#pragma once

#include <algorithm>
#include <span>
#include <tactus/tool_def_t.hpp>
#include <vector>

#include "haptic_node/devices/device.h"
#include "haptic_node/rendering/coupling.h"
#include "haptic_node/safety/passivity.h"
#include "haptic_node/contact/proxy.h"
#include "haptic_node/contact/rigid_proxy.h"
#include "haptic_node/settings.gen.h"

namespace tactus::haptic {

class ForceMethod {
 public:
  enum class Kind { kDirect, kProxy, kRigid };

  ForceMethod(const tool_def_t& tool, const Settings& settings);
  // Selects the method of the settings from the next tick on; it starts at the current proxy pose. Returns true
  // when the method has changed.
  bool change(const Settings& settings);
  Kind kind() const { return kind_; }
  // Minimum number of planes to consider, given the allowed number. Three planes hold a point and six a body; as
  // many again are the ones that it meets next (design).
  std::size_t planes(std::size_t allowed) const {
    return renders_torque() ? std::max<std::size_t>(allowed, 12) : allowed;
  }

  // Sets the proxy to the device pose, without contact state.
  void reset(const DeviceState& device);
  // Call when a touch model has arrived: restores the distance that the tool may move on it.
  void reset_reach(const DeviceState& device);
  // One tick: sets the depths. Realtime-safe: yes.
  void solve(std::span<Surface> surfaces, const DeviceState& device, double dt);
  // After solve(): the force of each surface on the hand, N.
  void compute_forces(std::span<const Surface> surfaces, const DeviceState& device, const CouplingFactors& factors,
                      std::span<Eigen::Vector3d> forces) const;
  // Energy in the springs to moving bodies or to fixed surfaces, at factor 1.
  enum class Partner { kBodies, kWalls };
  StoredEnergy stored_energy(std::span<const Surface> surfaces, Partner partner = Partner::kBodies) const;

  // Pose of the proxy; with direct rendering, of the device.
  const Eigen::Vector3d& position() const { return pose_.position; }
  const Eigen::Quaterniond& orientation() const { return pose_.orientation; }
  const Eigen::Vector3d& velocity() const { return velocity_; }  // m/s
  const Eigen::Vector3d& spin() const { return spin_; }          // rad/s
  // Orientation of the tool for which surfaces are placed; a point proxy has the orientation of the device.
  const Eigen::Quaterniond& tool_orientation(const DeviceState& device) const {
    return kind_ == Kind::kRigid ? pose_.orientation : device.orientation;
  }
  // From the centre of the proxy to its contact with a surface, m, world frame.
  Eigen::Vector3d arm(const Surface& s) const { return tool_pose().contact_point(s) - pose_.position; }
  ToolPose tool_pose() const { return {pose_.position, pose_.orientation, radius_m_}; }
  // Sum of force and torque. The torque is zero except with rigid rendering or direct rendering of a shape.
  Wrench sum(std::span<const Surface> surfaces, std::span<const Eigen::Vector3d> forces) const;
  // Changes the forces so that their sum is the constraint wrench that the hand feels.
  void distribute(const Wrench& felt, std::span<const Surface> surfaces, std::span<Eigen::Vector3d> forces);
  double lever_m() const { return rigid_.lever_m(); }
  // True when the torque is rendered.
  bool renders_torque() const { return kind_ == Kind::kRigid || (kind_ == Kind::kDirect && shaped_); }

 private:
  bool shaped_;
  double radius_m_, bound_m_;
  Kind kind_;
  double proxy_reach_m_, proxy_reach_time_s_, force_limit_N_;
  double remaining_reach_m_ = 0;  // distance that the tool may still move on this touch model
  Proxy proxy_;
  RigidProxy rigid_;
  DevicePose pose_;
  Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero(), spin_ = Eigen::Vector3d::Zero();
  std::vector<Eigen::Vector3d> arms_;  // scratch
};

// Distance that keeps a ball off a surface, m; zero for a shape, whose points touch directly.
inline double skin_m(const tool_def_t& tool) { return tool.shape == tool_def_t::BALL ? tool.radius_m : 0; }

}  // namespace tactus::haptic
