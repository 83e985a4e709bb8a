#include "haptic_node/rendering/rigid_coupling.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace tactus::haptic {
namespace {

constexpr double kRigid_N_m = 1e12, kImmovable_kg = 1e10;

Eigen::Vector3d tangential(const Eigen::Vector3d& v, const Eigen::Vector3d& normal) {
  return v - v.dot(normal) * normal;
}

Eigen::Vector3d clamped(const Eigen::Vector3d& v, double max_norm) {
  const double size = v.norm();
  return size > max_norm ? Eigen::Vector3d(v * (max_norm / size)) : v;
}

// Velocity of the tool of the device over a surface at the contact point, m/s.
Eigen::Vector3d relative_velocity(const Surface& s, const DeviceState& device, const Eigen::Vector3d& arm) {
  return device.velocity + device.spin.cross(arm) - s.velocity_at(s.point);
}

// normal, moment / lever|^2: a contact off the centre is less stiff in translation by this factor; the rest is
// rotation.
double off_centre_factor(const Surface& s, const Eigen::Vector3d& arm, double lever_m) {
  return 1 + (arm.cross(s.normal) / lever_m).squaredNorm();
}

// The same in N m/rad, N m s/rad and kg m2. A lag that needs no damper scales with the inertia, like the energy.
CouplingLimits turning_limits(const Settings& s) {
  CouplingLimits limits{s.turn_stiffness_limit_Nm_rad, s.mass_factor, s.damping_ratio, s.device_inertia_kgm2,
                        s.device_turn_damping_Nms_rad};
  limits.free_lag_N_s_m *= s.device_inertia_kgm2 / s.device_mass_kg;
  return limits;
}

// Of a wall without compliance.
double stiffest(const CouplingLimits& limits, double period_s, double device_delay_s) {
  return coupling_gains(kRigid_N_m, 0, kImmovable_kg, period_s, period_s, limits, device_delay_s).stiffness_N_m;
}

}  // namespace

double coupling_lever_m(const Settings& s) {
  const double period_s = 1 / s.rate_Hz;
  const CouplingLimits moving{s.stiffness_limit_N_m, s.mass_factor, s.damping_ratio, s.device_mass_kg,
                              s.device_damping_Ns_m};
  return std::sqrt(stiffest(turning_limits(s), period_s, 0) / stiffest(moving, period_s, 0));
}

double turning_limit_N_m(const Settings& s, double lever_m, double period_s, double device_delay_s) {
  return stiffest(turning_limits(s), period_s, device_delay_s) / (lever_m * lever_m);
}

void rigid_forces(std::span<const Surface> surfaces, const RigidProxy& proxy, const DeviceState& device,
                  const CouplingFactors& factors, std::span<Eigen::Vector3d> forces) {
  const std::size_t n = std::min({surfaces.size(), forces.size(), kMaxHalfSpaces});
  std::array<double, kMaxHalfSpaces> rate{};  // of each depth, m/s
  proxy.depth_rates(surfaces, device.velocity, device.spin, {rate.data(), n});
  double pressed = 0;
  for (const Surface& s : surfaces) pressed += s.depth_m;
  for (std::size_t i = 0; i < n; ++i) {
    const Surface& s = surfaces[i];
    forces[i].setZero();
    if (s.depth_m <= 0) continue;
    const Eigen::Vector3d arm = proxy.arm(s);
    const Eigen::Vector3d slip_velocity = tangential(relative_velocity(s, device, arm), s.normal);
    const double share = s.depth_m / pressed;
    if (!proxy.feasible())
      rate[i] =
          -share * relative_velocity(s, device, arm).dot(s.normal) / off_centre_factor(s, arm, proxy.lever_m());
    const auto [K, B] = rendered_gains(s, factors, pressed);
    const double normal = std::max(0.0, K * s.depth_m + B * rate[i]);
    Eigen::Vector3d along = K * s.grip;
    if (!s.slipping) along -= share * B / off_centre_factor(s, arm, proxy.lever_m()) * slip_velocity;
    forces[i] = normal * s.normal + clamped(along, normal * (s.slipping ? s.friction_dynamic : s.friction_static));
  }
}

void direct_forces(std::span<const Surface> surfaces, const DeviceState& device, double lever_m,
                   double tool_radius_m, const CouplingFactors& factors, std::span<Eigen::Vector3d> forces) {
  double pressed = 0;
  for (const Surface& s : surfaces) pressed += s.depth_m;
  for (std::size_t i = 0; i < surfaces.size() && i < forces.size(); ++i) {
    const Surface& s = surfaces[i];
    forces[i].setZero();
    if (s.depth_m <= 0) continue;
    const Eigen::Vector3d arm = device.orientation * s.tool_point - tool_radius_m * s.normal;
    const Eigen::Vector3d speed = relative_velocity(s, device, arm);
    const auto [K, B] = rendered_gains(s, factors, pressed);
    const double damping = s.depth_m / pressed * B / off_centre_factor(s, arm, lever_m);
    const double normal = std::max(0.0, K * s.depth_m - damping * speed.dot(s.normal));
    forces[i] = normal * s.normal + clamped(-damping * tangential(speed, s.normal), normal * s.friction_dynamic);
  }
}

void share_wrench(const Wrench& felt, std::span<const Eigen::Vector3d> arms, std::span<Eigen::Vector3d> forces,
                  double max_couple_N) {
  double sizes = 0, lever_m = 0;
  for (const Eigen::Vector3d& f : forces) sizes += f.norm();
  if (!(sizes > 0)) return;
  for (std::size_t i = 0; i < forces.size(); ++i) lever_m = std::max(lever_m, arms[i].norm());
  lever_m = std::max(lever_m, 1e-3);
  // Two passes. The first makes the force exact. The second uses the remaining freedom, force couples, for the
  // torque. About the mean of the contact points, weighted by force, the two do not interact.
  Eigen::Vector3d middle = Eigen::Vector3d::Zero(), force = felt.force_N, torque = felt.torque_N_m;
  for (std::size_t i = 0; i < forces.size(); ++i) {
    middle += forces[i].norm() / sizes * arms[i];
    force -= forces[i];
    torque -= arms[i].cross(forces[i]);
  }
  torque -= middle.cross(force);
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < forces.size(); ++i) {
    const Eigen::Vector3d r = arms[i] - middle;
    inertia += forces[i].norm() / sizes * (r.squaredNorm() * Eigen::Matrix3d::Identity() - r * r.transpose());
  }
  // No torque is possible about an axis on which all contact points lie.
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(inertia);
  Eigen::Vector3d couple = Eigen::Vector3d::Zero();
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d axis = axes.eigenvectors().col(k);
    if (axes.eigenvalues()[k] > 1e-6 * lever_m * lever_m)
      couple += axis * (axis.dot(torque) / axes.eigenvalues()[k]);
  }
  double largest_N = 0;
  for (std::size_t i = 0; i < forces.size(); ++i)
    largest_N = std::max(largest_N, forces[i].norm() / sizes * couple.cross(arms[i] - middle).norm());
  if (largest_N > max_couple_N) couple *= max_couple_N / largest_N;
  for (std::size_t i = 0; i < forces.size(); ++i) {
    const double weight = forces[i].norm() / sizes;
    forces[i] += weight * (force + couple.cross(arms[i] - middle));
  }
}

}  // namespace tactus::haptic
