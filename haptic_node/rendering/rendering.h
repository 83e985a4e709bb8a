// How the constraint force is made of the surfaces near the tool, one of three ways, which may be changed while
// the hand is pressed: direct, a spring at the device itself; proxy, a point that stays on the surfaces, force
// alone; rigid, a body that does, with torque.
#pragma once

#include <algorithm>
#include <span>
#include <tactus/tool_def_t.hpp>
#include <vector>

#include "haptic_node/devices/device.h"
#include "haptic_node/safety/passivity.h"
#include "haptic_node/contact/proxy.h"
#include "haptic_node/contact/rigid_proxy.h"
#include "haptic_node/settings.gen.h"

namespace tactus::haptic {

class Rendering {
 public:
  enum class Kind { kDirect, kProxy, kRigid };

  Rendering(const tool_def_t& tool, const Settings& settings);
  // Another from the next tick on, as the settings say: it begins where the one before had the proxy. True: it is
  // another.
  bool change(const Settings& settings);
  Kind kind() const { return kind_; }
  // Of so many planes that may be considered, how many must be: three hold a point, six a body, and as many again
  // are what it meets next (design).
  std::size_t planes(std::size_t allowed) const { return turns() ? std::max<std::size_t>(allowed, 12) : allowed; }

  // The proxy is where the device is, and holds nothing.
  void reset(const DeviceState& device);
  // A touch model has come: so much further the tool may go.
  void renew(const DeviceState& device);
  // One tick: sets depths. Realtime-safe: yes.
  void solve(std::span<Surface> surfaces, const DeviceState& device, double dt);
  // Then the force of each surface on the hand, N. factor: on the stiffness of the coupling to what moves.
  void press(std::span<const Surface> surfaces, const DeviceState& device, double factor,
             std::span<Eigen::Vector3d> forces) const;
  // And what their springs hold, of those that move, with a factor of 1.
  Stored stored(std::span<const Surface> surfaces) const;

  // Of the proxy; of direct rendering, the device's.
  const Eigen::Vector3d& position() const { return pose_.position; }
  const Eigen::Quaterniond& orientation() const { return pose_.orientation; }
  const Eigen::Vector3d& velocity() const { return velocity_; }  // m/s
  const Eigen::Vector3d& spin() const { return spin_; }          // rad/s
  // How the tool is turned for which surfaces are to be placed: a point proxy follows the device in that.
  const Eigen::Quaterniond& turned(const DeviceState& device) const {
    return kind_ == Kind::kRigid ? pose_.orientation : device.orientation;
  }
  // From the centre of the proxy to where it meets a surface, m, world.
  Eigen::Vector3d arm(const Surface& s) const { return place().touched(s) - pose_.position; }
  ToolPlace place() const { return {pose_.position, pose_.orientation, radius_m_}; }
  // Force and torque of all together; no torque unless it is rigid, or a shape is rendered directly.
  Wrench sum(std::span<const Surface> surfaces, std::span<const Eigen::Vector3d> forces) const;
  // Makes the forces such that together they are what the hand feels of the constraints.
  void share(const Wrench& felt, std::span<const Surface> surfaces, std::span<Eigen::Vector3d> forces);
  double lever_m() const { return rigid_.lever_m(); }
  // Torque is felt.
  bool turns() const { return kind_ == Kind::kRigid || (kind_ == Kind::kDirect && shaped_); }

 private:
  bool shaped_;
  double radius_m_, bound_m_;
  Kind kind_;
  double reach_m_, reach_time_s_, force_limit_N_;
  double left_m_ = 0;  // that the tool may go on this touch model
  Proxy proxy_;
  RigidProxy rigid_;
  DevicePose pose_;
  Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero(), spin_ = Eigen::Vector3d::Zero();
  std::vector<Eigen::Vector3d> arms_;  // scratch
};

// What keeps a ball off a surface, m; the points of a shape touch with themselves.
inline double skin_m(const tool_def_t& tool) { return tool.shape == tool_def_t::BALL ? tool.radius_m : 0; }

}  // namespace tactus::haptic
