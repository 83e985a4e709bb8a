// Contact points as rows that an impulse solver sweeps: each knows the bodies or joints that it moves, the
// velocity of its surfaces and what an impulse does to it. Contiguous, and built once a step.
#pragma once

#include <Eigen/Geometry>
#include <vector>

namespace tactus::sim::impulse {

// Velocities of everything that moves: of free bodies, and the rates of the joints of all systems one after the
// other. Twist 0 is that of what never moves.
struct Twist {
  Eigen::Vector3d linear_m_s = Eigen::Vector3d::Zero(), angular_rad_s = Eigen::Vector3d::Zero();
};
struct Velocities {
  std::vector<Twist> twists;
  std::vector<double> rates;
};
struct Inertness {  // of a free body, world axes; zero: never moves
  double inverse_mass_1_kg = 0;
  Eigen::Matrix3d inverse_inertia = Eigen::Matrix3d::Zero();
};

// What an impulse at a point does to a system of joints, in the axes of the point.
struct Coupling {
  std::size_t first_rate = 0, rates = 0;
  std::size_t jacobian = 0, response = 0;  // where each 3 x rates, row-major, begins in the pool
};

// How a point presses before its surfaces meet: not at all, with a spring and a damper of the end of the step, or
// with an impulse that is given.
enum class Press { kNone, kSoft, kGiven };

// In its own axes: normal (from a to b), and two tangents. Impulses act on b, and oppositely on a.
struct ContactPoint {
  int a = 0, b = 0;  // twists; 0 too for a link
  int first_coupling = 0, couplings = 0;
  Eigen::Matrix3d axes;                        // rows: normal, tangents
  Eigen::Vector3d arm_a, arm_b;                // from the centres of mass, m
  Eigen::Matrix3d mobility, inverse_mobility;  // velocity by unit impulse, 1/kg
  double sliding_mobility = 0;                 // largest along the tangents
  double friction = 0;
  double gap_m = 0;            // at the start of the step; negative: overlap
  double least_speed_m_s = 0;  // of parting that the contact asks for; negative: how fast the gap may close
  Eigen::Vector3d drift_m_s;   // of its velocity, from the start of the step to its mean, without impulses
  Eigen::Vector3d impulse = Eigen::Vector3d::Zero();  // N s, over the step
  double blow_N_s = 0;                                // along the normal, of collisions before
  int mover_a = 0, mover_b = 0;                       // as those of its group, plus one; 0: nothing
  int visit = -1;                                     // the one of the sweep at which it was last solved
  Press press = Press::kNone;
  double lasts_s = 0;  // what its impulse is the force of: from the middle of the step before to that of this one
  double soft_speed_m_s = 0, softness_1_kg = 0;  // kSoft: velocity + softness * impulse = soft speed
  double pressed_N_s = 0;                        // kGiven
  double shell_m = -1;                           // from which gap on it presses; negative: not known yet
};

// The points of one manifold.
struct ContactGroup {
  int first = 0, count = 0, manifold = 0;
  int mover_a = -1, mover_b = -1;  // what they move: a twist, or beyond those a system; -1: nothing
  double restitution = 0;
  // How the surfaces meet in the step: blows so far, at their first and last instants after its start, and the
  // point and speed of the first; without a blow, where the free motion leads. met: -1: nowhere.
  int impacts = 0, met = -1;
  double first_s = 0, last_s = 0, speed_m_s = 0;
  bool shielded = false;  // takes no blow: springs press
  bool stopped = false;   // by these, before the surfaces meet
};

class ContactRows {
 public:
  std::vector<ContactPoint> points;
  std::vector<ContactGroup> groups;
  std::vector<Coupling> couplings;
  std::vector<double> pool;
  std::vector<Inertness> inert;  // per twist

  void clear();
  // Of the surface of b against that of a, in the point's axes.
  Eigen::Vector3d velocity(const ContactPoint& p, const Velocities& v) const;
  void apply(const ContactPoint& p, const Eigen::Vector3d& impulse, Velocities& v) const;
  // The same as solve() where something presses before the surfaces meet.
  static Eigen::Vector3d answer(const ContactPoint& p, const Eigen::Vector3d& impulse, const Eigen::Vector3d& v) {
    return p.press == Press::kNone ? solve(p, impulse, v) : solve_pressed(p, impulse, v);
  }
  // Completes the mobility from the arms and couplings; call when those are set.
  void weigh(ContactPoint& p) const;

  // The impulse that the point should have instead of `impulse`, when its velocity less what is asked for is v:
  // none where the surfaces part anyway, no sliding where the cone allows it, otherwise on the cone and against
  // the sliding. The cone is round: |tangential| <= friction * normal. Fixed points satisfy Coulomb's law exactly.
  static Eigen::Vector3d solve(const ContactPoint& p, const Eigen::Vector3d& impulse, const Eigen::Vector3d& v);

 private:
  void add_velocity(const ContactPoint& p, const Velocities& v, Eigen::Vector3d& out) const;
  void apply_to_joints(const ContactPoint& p, const Eigen::Vector3d& impulse, Velocities& v) const;
  static Eigen::Vector3d solve_pressed(const ContactPoint& p, const Eigen::Vector3d& impulse,
                                       const Eigen::Vector3d& v);
  // alone: normal velocity without an impulse here.
  static Eigen::Vector3d solve_sliding(const ContactPoint& p, const Eigen::Vector3d& impulse,
                                       const Eigen::Vector3d& v, double alone);
};

// The innermost loop of a step is made of these three: written out, since products of whole matrices are not made
// inline and wait for what has just been stored. The order of the sums is theirs, so that states stay what they
// were to the bit.

// m * (x, y, z), added to or taken from out.
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
    const Inertness& m = inert[static_cast<std::size_t>(p.b)];
    const double k = m.inverse_mass_1_kg;
    b.linear_m_s[0] += k * x, b.linear_m_s[1] += k * y, b.linear_m_s[2] += k * z;
    const Eigen::Vector3d& r = p.arm_b;
    add_product<1>(b.angular_rad_s, m.inverse_inertia, r[1] * z - r[2] * y, r[2] * x - r[0] * z,
                   r[0] * y - r[1] * x);
  }
  if (p.a) {
    Twist& a = v.twists[static_cast<std::size_t>(p.a)];
    const Inertness& m = inert[static_cast<std::size_t>(p.a)];
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
  Eigen::Vector3d stuck = impulse;
  add_product<-1>(stuck, p.inverse_mobility, v.x(), v.y(), v.z());
  const double most = p.friction * stuck.x();
  if (stuck.x() >= 0 && stuck.y() * stuck.y() + stuck.z() * stuck.z() <= most * most) return stuck;
  return solve_sliding(p, impulse, v, alone);
}

}  // namespace tactus::sim::impulse
