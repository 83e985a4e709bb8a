// Links on joints in reduced coordinates: the joints cannot come apart, and the energy of a swing is kept to the
// accuracy of the integrator. Knows no contacts; the impulses of those arrive through strike().
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "sim_node/behaviour/articulated/dormand_prince.h"
#include "sim_node/behaviour/articulated/dynamics.h"
#include "sim_node/behaviour/articulated/tree.h"
#include "sim_node/model/body_motion.h"

namespace tactus::sim::articulated {

// How finely a step is divided where the motion is fast: a chain's whip turns its last joints at hundreds of
// rad/s.
struct Accuracy {
  double position = 1e-5;  // most error of a coordinate in one sub-step, rad or m
  double rate = 1e-4;      // of a rate, as a share of the fastest one plus 1 rad/s or m/s
  int most_substeps = 16;  // of one step: bounds its cost
};

class ArticulatedSystem {
 public:
  // step_s: the length that steps will have; decides which springs and dampers are too stiff to be integrated.
  // Throws std::invalid_argument: see Tree.
  explicit ArticulatedSystem(const std::vector<LinkDef>& links, double step_s = 0.001, Accuracy accuracy = {});

  // All that changes from step to step: copied out and in, the system continues to the bit.
  struct State {
    std::vector<double> positions, rates;  // as Dynamics::evaluate takes them
    double reach_s = 0;                    // length of sub-step to try next
  };
  const State& state() const { return state_; }
  void set_state(const State& state);

  // The loads of the next step, copied out and in likewise.
  struct Burden {
    Loads loads;
    bool loaded;
  };
  Burden burden() const { return {loads_, loaded_}; }
  void copy_burden(Burden& out) const { out.loads = loads_, out.loaded = loaded_; }
  void set_burden(const Burden& burden);

  // Act during the next step only; force N at a point of the world m, moment N m.
  void add_force(int link, const Eigen::Vector3d& force_N, const Eigen::Vector3d& point_m);
  void add_moment(int link, const Eigen::Vector3d& moment_N_m);
  // Acts along a degree of freedom from now on, N m or N.
  void set_torque(int dof, double torque);
  // Hold from now on.
  void set_gravity(int link, const Eigen::Vector3d& gravity_m_s2);
  void set_motor(int dof, double effort, double rate);
  void set_friction(int dof, double friction);

  // Of every dof, at the present state. Realtime-safe: yes.
  std::span<const double> accelerations();
  // Lets time pass. Realtime-safe: yes; at most six evaluations for each of most_substeps plus as many refused.
  void step(double h_s);

  // Adds to the rates; to the coordinates, as moving at these rates for one second would.
  void add_rates(std::span<const double> change);
  void displace(std::span<const double> by);

  const Tree& tree() const { return *tree_; }
  // At the present pose: for strike(), response() and jacobian().
  Dynamics& dynamics();
  // Springs and dampers of this dof are left to the contact solver, which takes them implicitly.
  bool is_stiff(int dof) const { return !passive_[static_cast<std::size_t>(dof)]; }

  BodyMotion motion(int link) const;  // position and orientation: of the centre, turned since rest
  double kinetic_energy_J();
  double potential_energy_J();                     // of weight and springs; zero weight at the origin
  int substeps_last() const { return substeps_; }  // tried in the last step

 private:
  void slope_of(const std::vector<double>& y, std::vector<double>& slope);
  void refresh();
  double relative_error() const;

  std::unique_ptr<Tree> tree_;
  Accuracy accuracy_;
  Dynamics dynamics_;
  Loads loads_;
  State state_;
  std::vector<char> passive_;
  DormandPrince pair_;
  std::vector<double> y_;  // positions, then rates
  bool slope_known_ = false, placed_ = false, loaded_ = false;
  int substeps_ = 0;
};

}  // namespace tactus::sim::articulated
