#include "sim_node/behaviour/impulse/penalty.h"

#include <algorithm>

namespace tactus::sim::impulse {

void set_penalty_shells(ContactRows& rows, const Penalty& penalty, const Velocities& velocity, double h) {
  for (ContactGroup& g : rows.groups) {
    g.stopped_by_spring = true;
    for (int i = g.first; i < g.first + g.count; ++i) {
      ContactPoint& p = rows.points[static_cast<std::size_t>(i)];
      const double closing = -rows.velocity(p, velocity).x();
      if (penalty.rise_m_s <= 0)
        p.shell_m = penalty.thickness_m;
      else if (p.shell_m < 0)
        p.shell_m = std::clamp(p.gap_m + h * std::max(0.0, closing), 0.0, penalty.thickness_m);
      else
        p.shell_m = std::min(penalty.thickness_m, p.shell_m + h * penalty.rise_m_s);
      // Compares kinetic energy with the remaining capacity of the spring: v^2 / 2 M against k (shell^2 - inside^2) /
      // 2.
      const double inside = std::clamp(p.shell_m - p.gap_m, 0.0, p.shell_m);
      const double bears = penalty.stiffness_N_m * p.mobility(0, 0) * (p.shell_m * p.shell_m - inside * inside);
      if (closing > 0 && closing * closing > bears) g.stopped_by_spring = false;
    }
    g.spring_only = g.stopped_by_spring || g.restitution == 0;
  }
}

void set_penalty_forces(ContactRows& rows, const Penalty& penalty, const Velocities& velocity, double h) {
  for (ContactPoint& p : rows.points) {
    p.force_time_s = h;
    const double inside = p.shell_m - p.gap_m;
    const double damping =
        penalty.damping_N_s_m * std::clamp(inside / (kDampingOnsetShare * penalty.thickness_m), 0.0, 1.0);
    if (penalty.is_explicit) {
      // Closing speed of the previous step, without the forces of this one. Otherwise a resting body would seem to
      // sink.
      const double closing = 2 * p.drift_m_s.x() - rows.velocity(p, velocity).x();
      p.penalty_force = PenaltyForce::kExplicit;
      p.explicit_impulse_N_s =
          inside > 0 ? std::max(0.0, h * (penalty.stiffness_N_m * inside + damping * closing)) : 0.0;
    } else {
      const SoftRow row = soft_row(penalty.stiffness_N_m, damping, h);
      p.penalty_force = PenaltyForce::kImplicit;
      p.softness_1_kg = row.cfm_m_s_N / h;
      p.penalty_speed_m_s = row.erp * inside / h;
    }
  }
}

// Solves the normal first, then friction within its cone. Sweeps couple the two.
Eigen::Vector3d ContactRows::solve_penalty(const ContactPoint& p, const Eigen::Vector3d& impulse,
                                           const Eigen::Vector3d& v) {
  const double k = p.mobility(0, 0);
  double normal = p.explicit_impulse_N_s;
  if (p.penalty_force == PenaltyForce::kImplicit) {
    const double lacks = v.x() + p.min_speed_m_s - p.penalty_speed_m_s + p.softness_1_kg * impulse.x();
    normal = std::max(0.0, impulse.x() - lacks / (k + p.softness_1_kg));
  }
  // The body crosses the shell: the surfaces meet.
  if (v.x() + k * (normal - impulse.x()) < 0) normal = std::max(0.0, impulse.x() - v.x() / k);
  const Eigen::Vector2d sliding = v.tail<2>() + p.mobility.block<2, 1>(1, 0) * (normal - impulse.x());
  const double a = p.mobility(1, 1), b = p.mobility(1, 2), d = p.mobility(2, 2), det = a * d - b * b;
  const Eigen::Vector2d sticking =
      impulse.tail<2>() -
      Eigen::Vector2d(d * sliding.x() - b * sliding.y(), a * sliding.y() - b * sliding.x()) / det;
  const double max_tangential = p.friction * normal;
  if (sticking.squaredNorm() <= max_tangential * max_tangential) return {normal, sticking.x(), sticking.y()};
  const Eigen::Vector2d slides = impulse.tail<2>() - sliding / p.sliding_mobility;
  const double size = slides.norm();
  if (size == 0) return {normal, 0, 0};
  return {normal, slides.x() * max_tangential / size, slides.y() * max_tangential / size};
}

}  // namespace tactus::sim::impulse
