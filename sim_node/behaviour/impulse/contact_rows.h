// Contact points as rows that an impulse solver sweeps: each knows the bodies or joints that it moves, the
// velocity of its surfaces and what an impulse does to it. Contiguous, and built once a step.
#pragma once

#include <Eigen/Core>
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
};

// The points of one manifold.
struct ContactGroup {
  int first = 0, count = 0, manifold = 0;
  int mover_a = -1, mover_b = -1;  // what they move: a twist, or beyond those a system; -1: nothing
  double restitution = 0;
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
  // Completes the mobility from the arms and couplings; call when those are set.
  void weigh(ContactPoint& p) const;

  // The impulse that the point should have instead of `impulse`, when its velocity less what is asked for is v:
  // none where the surfaces part anyway, no sliding where the cone allows it, otherwise on the cone and against
  // the sliding. The cone is round: |tangential| <= friction * normal. Fixed points satisfy Coulomb's law exactly.
  static Eigen::Vector3d solve(const ContactPoint& p, const Eigen::Vector3d& impulse, const Eigen::Vector3d& v);
};

}  // namespace tactus::sim::impulse
