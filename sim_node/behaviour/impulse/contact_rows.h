// Contact points as constraint rows for the sweeps of an impulse solver: each stores its bodies or joints, and gives
// the relative velocity of its surfaces and the effect of an impulse. Contiguous, rebuilt in each step.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "sim_node/behaviour/impulse/round_shape.h"

namespace tactus::sim::impulse {

// Velocities of all moving bodies: twists of free bodies, and the joint rates of all systems in sequence. Twist 0
// belongs to static bodies.
struct Twist {
  Eigen::Vector3d linear_m_s = Eigen::Vector3d::Zero(), angular_rad_s = Eigen::Vector3d::Zero();
};
struct Velocities {
  std::vector<Twist> twists;
  std::vector<double> rates;
};
struct InverseInertia {  // of a free body, world axes; zero: static
  double inverse_mass_1_kg = 0;
  Eigen::Matrix3d inverse_inertia = Eigen::Matrix3d::Zero();
};

// Effect of an impulse at a point on a system of joints, in the axes of the point.
struct Coupling {
  std::size_t first_rate = 0, rates = 0;
  std::size_t jacobian = 0, response = 0;  // start of each 3 x rates matrix, row-major, in the pool
};

// Force of a point before its surfaces meet: none, a spring and damper evaluated at the end of the step (implicit),
// or a given impulse (explicit).
enum class PenaltyForce { kNone, kImplicit, kExplicit };

// In its own axes: normal (from a to b) and two tangents. Impulses act on b, and with opposite sign on a.
struct ContactPoint {
  int a = 0, b = 0;  // indices of twists; 0 also for a link
  int first_coupling = 0, couplings = 0;
  Eigen::Matrix3d axes;                        // rows: normal, tangents
  Eigen::Vector3d arm_a, arm_b;                // from the centres of mass, m
  Eigen::Matrix3d mobility, inverse_mobility;  // velocity per unit impulse, 1/kg
  double sliding_mobility = 0;                 // largest along the tangents
  double friction = 0;
  double gap_m = 0;            // at the start of the step; negative: overlap
  double min_speed_m_s = 0;  // minimum separating speed of the contact; negative: the gap may close at this speed
  double correction_m = 0;     // part of an overlap that positions correct in this step
  Eigen::Vector3d drift_m_s;   // of its velocity, from the start of the step to its mean, without impulses
  Eigen::Vector3d impulse = Eigen::Vector3d::Zero();  // N s, over the step
  double impact_N_s = 0;                              // along the normal, of the collision phase
  int mover_a = 0, mover_b = 0;                       // as in its group, plus one; 0: static
  int visit = -1;                                     // counter value at which it was last solved
  PenaltyForce penalty_force = PenaltyForce::kNone;
  double force_time_s = 0;  // time that relates its impulse to a force: from the middle of the previous step to the middle of this one
  double penalty_speed_m_s = 0, softness_1_kg = 0;  // kImplicit: velocity + softness * impulse = soft speed
  double explicit_impulse_N_s = 0;                  // kExplicit
  double shell_m = -1;                           // gap below which it presses; negative: not yet known
};

// The points of one manifold.
struct ContactGroup {
  int first = 0, count = 0, manifold = 0;
  int mover_a = -1, mover_b = -1;  // index of a twist, or beyond those of a system; -1: static
  double restitution = 0;
  RoundShape round_a = {}, round_b = {};  // world axes, of free bodies
  // Impacts in the step: their number, the times of the first and the last after its start, and the point and speed
  // of the first. Without an impact, the predicted meeting of the free motion. met: -1: none.
  int impacts = 0, first_impact_point = -1;
  double first_s = 0, last_s = 0, speed_m_s = 0;
  bool spring_only = false;        // no impulses: springs press
  bool stopped_by_spring = false;  // by springs, before the surfaces meet
};

class ContactRows {
 public:
  std::vector<ContactPoint> points;
  std::vector<ContactGroup> groups;
  std::vector<Coupling> couplings;
  std::vector<double> pool;
  std::vector<InverseInertia> inertias;  // per twist

  void clear();
  // Relative velocity of the surface of b with respect to a, in the point's axes.
  Eigen::Vector3d velocity(const ContactPoint& p, const Velocities& v) const;
  void apply(const ContactPoint& p, const Eigen::Vector3d& impulse, Velocities& v) const;
  // Distance along the normal by which the surfaces leave their linear path within h_s, since both rotate: positive
  // where they open. h^2 / 2 n . (w x (w x r)) of b, less that of a.
  double path_bend_m(const ContactPoint& p, const Velocities& v, double h_s) const;
  // The same as solve(), with support for points that press before the surfaces meet.
  static Eigen::Vector3d solve_point(const ContactPoint& p, const Eigen::Vector3d& impulse, const Eigen::Vector3d& v) {
    return p.penalty_force == PenaltyForce::kNone ? solve(p, impulse, v) : solve_penalty(p, impulse, v);
  }
  // Computes the mobility from the arms and couplings. Call it after they are set.
  void compute_mobility(ContactPoint& p) const;

  // Returns the impulse that replaces `impulse` at a velocity v, measured relative to the required velocity: zero
  // when the surfaces separate anyway, without sliding when the friction cone allows it, otherwise on the cone and
  // opposite to the sliding. The cone is round:
  // tangential
  // <= friction * normal. Fixed points satisfy Coulomb's law exactly.
  static Eigen::Vector3d solve(const ContactPoint& p, const Eigen::Vector3d& impulse, const Eigen::Vector3d& v);

 private:
  void add_velocity(const ContactPoint& p, const Velocities& v, Eigen::Vector3d& out) const;
  void apply_to_joints(const ContactPoint& p, const Eigen::Vector3d& impulse, Velocities& v) const;
  static Eigen::Vector3d solve_penalty(const ContactPoint& p, const Eigen::Vector3d& impulse,
                                       const Eigen::Vector3d& v);
  // alone: normal velocity without an impulse here.
  static Eigen::Vector3d solve_sliding(const ContactPoint& p, const Eigen::Vector3d& impulse,
                                       const Eigen::Vector3d& v, double alone);
};

// The innermost loop of a step consists of these three functions. They are written out, since the compiler does not
// inline products of whole matrices and these wait for recent stores. The order of the sums is that of the matrix
// products, so that results stay bit-identical.

// Adds m * (x, y, z) to out, or subtracts it.
template <int kSign>
inline void add_product(Eigen::Vector3d& out, const Eigen::Matrix3d& m, double x, double y, double z) {
  const double* c = m.data();  // by columns
  const double r0 = c[0] * x + c[3] * y + c[6] * z, r1 = c[1] * x + c[4] * y + c[7] * z,
               r2 = c[2] * x + (c[5] * y + c[8] * z);
  if constexpr (kSign > 0)
    out[0] += r0, out[1] += r1, out[2] += r2;
  else
    out[0] -= r0, out[1] -= r1, out[2] -= r2;
}

[[gnu::always_inline]] inline Eigen::Vector3d ContactRows::velocity(const ContactPoint& p,
                                                                    const Velocities& v) const {
  const Twist& b = v.twists[static_cast<std::size_t>(p.b)];
  const Eigen::Vector3d &u = b.linear_m_s, &w = b.angular_rad_s, &r = p.arm_b;
  double x = u[0] + (w[1] * r[2] - w[2] * r[1]), y = u[1] + (w[2] * r[0] - w[0] * r[2]),
         z = u[2] + (w[0] * r[1] - w[1] * r[0]);
  if (p.a) {
    const Twist& a = v.twists[static_cast<std::size_t>(p.a)];
    const Eigen::Vector3d &t = a.linear_m_s, &s = a.angular_rad_s, &q = p.arm_a;
    x -= t[0] + (s[1] * q[2] - s[2] * q[1]);
    y -= t[1] + (s[2] * q[0] - s[0] * q[2]);
    z -= t[2] + (s[0] * q[1] - s[1] * q[0]);
  }
  const double* c = p.axes.data();
  Eigen::Vector3d out(c[0] * x + c[3] * y + c[6] * z, c[1] * x + c[4] * y + c[7] * z,
                      c[2] * x + (c[5] * y + c[8] * z));
  if (p.couplings > 0) add_velocity(p, v, out);
  return out;
}

[[gnu::always_inline]] inline void ContactRows::apply(const ContactPoint& p, const Eigen::Vector3d& impulse,
                                                      Velocities& v) const {
  const double* c = p.axes.data();
  const double n = impulse[0], s = impulse[1], t = impulse[2];
  const double x = c[0] * n + c[1] * s + c[2] * t, y = c[3] * n + c[4] * s + c[5] * t,
               z = c[6] * n + c[7] * s + c[8] * t;
  if (p.b) {
    Twist& b = v.twists[static_cast<std::size_t>(p.b)];
    const InverseInertia& m = inertias[static_cast<std::size_t>(p.b)];
    const double k = m.inverse_mass_1_kg;
    b.linear_m_s[0] += k * x, b.linear_m_s[1] += k * y, b.linear_m_s[2] += k * z;
    const Eigen::Vector3d& r = p.arm_b;
    add_product<1>(b.angular_rad_s, m.inverse_inertia, r[1] * z - r[2] * y, r[2] * x - r[0] * z,
                   r[0] * y - r[1] * x);
  }
  if (p.a) {
    Twist& a = v.twists[static_cast<std::size_t>(p.a)];
    const InverseInertia& m = inertias[static_cast<std::size_t>(p.a)];
    const double k = m.inverse_mass_1_kg;
    a.linear_m_s[0] -= k * x, a.linear_m_s[1] -= k * y, a.linear_m_s[2] -= k * z;
    const Eigen::Vector3d& r = p.arm_a;
    add_product<-1>(a.angular_rad_s, m.inverse_inertia, r[1] * z - r[2] * y, r[2] * x - r[0] * z,
                    r[0] * y - r[1] * x);
  }
  if (p.couplings > 0) apply_to_joints(p, impulse, v);
}

[[gnu::always_inline]] inline Eigen::Vector3d ContactRows::solve(const ContactPoint& p,
                                                                 const Eigen::Vector3d& impulse,
                                                                 const Eigen::Vector3d& v) {
  const double alone = v.x() - p.mobility.row(0).dot(impulse);
  if (alone >= 0) return Eigen::Vector3d::Zero();
  Eigen::Vector3d sticking = impulse;
  add_product<-1>(sticking, p.inverse_mobility, v.x(), v.y(), v.z());
  const double max_tangential = p.friction * sticking.x();
  if (sticking.x() >= 0 &&
      sticking.y() * sticking.y() + sticking.z() * sticking.z() <= max_tangential * max_tangential)
    return sticking;
  return solve_sliding(p, impulse, v, alone);
}

}  // namespace tactus::sim::impulse
