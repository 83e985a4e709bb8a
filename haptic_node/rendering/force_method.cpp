#include "haptic_node/rendering/force_method.h"

#include "haptic_node/contact/direct.h"
#include "haptic_node/rendering/rigid_coupling.h"

namespace tactus::haptic {
namespace {

// The limit in tool_touch.h of the simulation, which does not search further around a tool that reports a higher
// speed. Design: faster than an exploring hand (a reach is 1 to 2 m/s).
constexpr double kMaxHandSpeed_m_s = 5;

ForceMethod::Kind kind_of(const std::string& name, bool shaped) {
  if (name == "direct") return ForceMethod::Kind::kDirect;
  if (name == "proxy") return ForceMethod::Kind::kProxy;
  if (name == "rigid") return ForceMethod::Kind::kRigid;
  return shaped ? ForceMethod::Kind::kRigid : ForceMethod::Kind::kProxy;
}

DevicePose pose_of(const DeviceState& device) { return {device.position, device.orientation}; }

}  // namespace

ForceMethod::ForceMethod(const tool_def_t& tool, const Settings& settings)
    : shaped_(tool.shape != tool_def_t::BALL),
      radius_m_(skin_m(tool)),
      bound_m_(tool.radius_m),
      kind_(kind_of(settings.rendering, shaped_)),
      proxy_reach_m_(settings.proxy_reach_m),
      proxy_reach_time_s_(settings.proxy_reach_time_s),
      force_limit_N_(settings.force_limit_N),
      rigid_(coupling_lever_m(settings), bound_m_, radius_m_) {
  arms_.reserve(kMaxHalfSpaces);
}

bool ForceMethod::change(const Settings& settings) {
  const Kind wanted = kind_of(settings.rendering, shaped_);
  if (wanted == kind_) return false;
  kind_ = wanted;
  proxy_.reset(pose_.position);
  rigid_.reset(pose_);
  return true;
}

void ForceMethod::reset(const DeviceState& device) {
  pose_ = pose_of(device);
  proxy_.reset(device.position);
  rigid_.reset(pose_);
  reset_reach(device);
}

void ForceMethod::reset_reach(const DeviceState& device) {
  const double speed_m_s = device.velocity.norm() + bound_m_ * device.spin.norm();
  remaining_reach_m_ = proxy_reach_m_ + proxy_reach_time_s_ * std::min(speed_m_s, kMaxHandSpeed_m_s);
}

void ForceMethod::solve(std::span<Surface> surfaces, const DeviceState& device, double dt) {
  const DevicePose placed{pose_.position, tool_orientation(device)};
  switch (kind_) {
    case Kind::kProxy:
      proxy_.step(surfaces, device.position, dt);
      pose_ = {proxy_.position(), device.orientation};
      velocity_ = proxy_.velocity();
      spin_ = device.spin;
      break;
    case Kind::kRigid:
      rigid_.step(surfaces, pose_of(device), dt, remaining_reach_m_);
      remaining_reach_m_ = std::max(0.0, remaining_reach_m_ - rigid_.moved_m());
      pose_ = {rigid_.position(), rigid_.orientation()};
      velocity_ = rigid_.velocity();
      spin_ = rigid_.spin();
      break;
    case Kind::kDirect:
      compute_direct_depths(surfaces, placed, pose_of(device), rigid_.lever_m(), radius_m_);
      pose_ = pose_of(device);
      velocity_ = device.velocity;
      spin_ = device.spin;
      break;
  }
}

void ForceMethod::compute_forces(std::span<const Surface> surfaces, const DeviceState& device,
                                 const CouplingFactors& factors, std::span<Eigen::Vector3d> forces) const {
  switch (kind_) {
    case Kind::kProxy:
      coupling_forces(surfaces, proxy_.shift(), device.velocity, proxy_.slipping(), forces, factors);
      break;
    case Kind::kRigid: rigid_forces(surfaces, rigid_, device, factors, forces); break;
    case Kind::kDirect: direct_forces(surfaces, device, rigid_.lever_m(), radius_m_, factors, forces); break;
  }
}

StoredEnergy ForceMethod::stored_energy(std::span<const Surface> surfaces, Partner partner) const {
  StoredEnergy all;
  Eigen::Vector3d push_N = Eigen::Vector3d::Zero(), depth_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d moment_N = Eigen::Vector3d::Zero(), turn_m = Eigen::Vector3d::Zero();
  double stiffest_N_m = 0, friction_J = 0, each_J = 0;
  for (const Surface& s : surfaces) {
    if (s.depth_m <= 0 || s.movable() != (partner == Partner::kBodies)) continue;
    all.pressed = true;
    const double K = s.coupling_stiffness_N_m;
    push_N += K * s.depth_m * s.normal;
    depth_m += s.depth_m * s.normal;
    stiffest_N_m = std::max(stiffest_N_m, K);
    each_J += 0.5 * K * s.depth_m * s.depth_m;
    if (!renders_torque()) continue;
    const Eigen::Vector3d moment = arm(s).cross(s.normal) / lever_m();
    moment_N += K * s.depth_m * moment;
    turn_m += s.depth_m * moment;
    friction_J += 0.5 * K * s.grip.squaredNorm();
  }
  if (kind_ == Kind::kProxy) friction_J = 0.5 * stiffest_N_m * proxy_.shift().squaredNorm();
  // Where the surfaces leave no feasible pose, or each is a spring at the device, their energies do not combine
  // into one displacement.
  const bool one = kind_ == Kind::kProxy ? proxy_.feasible() : kind_ == Kind::kRigid && rigid_.feasible();
  all.energy_J = friction_J + (one ? 0.5 * push_N.dot(depth_m) + 0.5 * moment_N.dot(turn_m) : each_J);
  // The hand has pressed where it is deeper than when the surface appeared. The depths along the normals count: between
  // walls that wedge the tool, the multipliers of the solver are much larger.
  double appeared = all.pressed ? 1 : 0;
  for (const Surface& s : surfaces) {
    if (s.depth_m <= 0 || s.movable() != (partner == Partner::kBodies)) continue;
    double deep_m = one ? s.normal.dot(depth_m) : s.depth_m;
    if (one && renders_torque()) deep_m += arm(s).cross(s.normal).dot(turn_m) / lever_m();
    // The height of its map comes with the surface.
    const double own_m = s.appeared_m + std::max(0.0, s.mapped.height_m);
    if (deep_m > own_m) appeared = std::min(appeared, own_m / deep_m);
  }
  all.appeared_J = appeared * appeared * all.energy_J;
  return all;
}

Wrench ForceMethod::sum(std::span<const Surface> surfaces, std::span<const Eigen::Vector3d> forces) const {
  Wrench w;
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    w.force_N += forces[i];
    if (renders_torque()) w.torque_N_m += arm(surfaces[i]).cross(forces[i]);
  }
  return w;
}

void ForceMethod::distribute(const Wrench& felt, std::span<const Surface> surfaces,
                             std::span<Eigen::Vector3d> forces) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double total_N = 0;
  for (const Eigen::Vector3d& f : forces) {
    sum += f;
    total_N += f.norm();
  }
  if (total_N <= 0) return;
  // Each force keeps its direction as far as the sum does; the rest is shared by magnitude.
  const double square = sum.squaredNorm();
  const double kept = square > 0 ? std::clamp(felt.force_N.dot(sum) / square, 0.0, 1.0) : 0.0;
  const Eigen::Vector3d rest = felt.force_N - kept * sum;
  for (Eigen::Vector3d& f : forces) f = kept * f + f.norm() / total_N * rest;
  if (!renders_torque()) return;
  arms_.clear();
  for (const Surface& s : surfaces) arms_.push_back(arm(s));
  share_wrench(felt, arms_, forces, force_limit_N_);
}

}  // namespace tactus::haptic
