#include "haptic_node/coupling.h"

#include <cmath>

namespace tactus::haptic {
namespace {

constexpr double kFixed_kg = 1e9;

}  // namespace

Gains coupling_gains(double surface_stiffness_N_m, double surface_damping_N_s_m, double body_mass_kg,
                     double loop_delay_s, double period_s, const CouplingLimits& limits) {
  const bool fixed = body_mass_kg >= kFixed_kg;
  const double rho = fixed ? 1 : body_mass_kg / (body_mass_kg + limits.device_mass_kg);
  const double reduced_kg = rho * limits.device_mass_kg;
  const double b = limits.device_damping_N_s_m, most_damping = b / 2;
  const double of_device = b * rho * rho;

  Gains g;
  g.stiffness_N_m =
      std::min({surface_stiffness_N_m, limits.stiffness_limit_N_m, 2 * (b - most_damping) / period_s});
  if (!fixed)
    g.stiffness_N_m = std::min(g.stiffness_N_m, limits.mass_factor * body_mass_kg / (loop_delay_s * loop_delay_s));
  const double critical = (most_damping + of_device) / (2 * limits.damping_ratio);
  g.stiffness_N_m = std::min(g.stiffness_N_m, critical * critical / reduced_kg);
  const double needed = 2 * limits.damping_ratio * std::sqrt(g.stiffness_N_m * reduced_kg) - of_device;
  // A light body with much damping would be dragged faster than the loop can tell: the same factor bounds B tau /
  // m.
  double most = most_damping;
  if (!fixed) most = std::min(most, std::max(needed, limits.mass_factor * body_mass_kg / loop_delay_s));
  g.damping_N_s_m = std::clamp(std::max(needed, surface_damping_N_s_m), 0.0, most);
  return g;
}

void LoopDelay::pass(double age_s, double dt) {
  peak_s_ *= std::exp(-dt / kForget_s);
  mean_s_ += (1 - std::exp(-dt / kMean_s)) * (std::clamp(age_s, 0.0, kLongest_s) - mean_s_);
}

void coupling_forces(std::span<const Surface> surfaces, const Eigen::Vector3d& shift_m,
                     const Eigen::Vector3d& device_velocity, bool slipping, std::span<Eigen::Vector3d> forces) {
  double cone_m = 0;
  const auto friction = [&](const Surface& s) { return slipping ? s.friction_dynamic : s.friction_static; };
  for (const Surface& s : surfaces) cone_m += s.depth_m * friction(s);
  for (std::size_t i = 0; i < surfaces.size() && i < forces.size(); ++i) {
    const Surface& s = surfaces[i];
    forces[i].setZero();
    if (s.depth_m <= 0) continue;
    const Eigen::Vector3d relative = device_velocity - s.velocity_at(s.point);
    const double normal_speed = relative.dot(s.normal);
    const double normal_force =
        std::max(0.0, s.coupling_stiffness_N_m * s.depth_m - s.coupling_damping_N_s_m * normal_speed);
    forces[i] = normal_force * s.normal;
    if (cone_m <= 0) continue;
    const double share = s.depth_m * friction(s) / cone_m;
    Eigen::Vector3d tangential = share * s.coupling_stiffness_N_m * shift_m;
    if (!slipping) tangential -= share * s.coupling_damping_N_s_m * (relative - normal_speed * s.normal);
    const double most = friction(s) * normal_force, size = tangential.norm();
    if (size > most) tangential *= most / size;
    forces[i] += tangential;
  }
}

}  // namespace tactus::haptic
