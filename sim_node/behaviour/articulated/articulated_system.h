// Articulated bodies in reduced coordinates: joints cannot drift apart, and the energy of a swing is conserved to
// the accuracy of the integrator. Independent of contacts; their impulses are applied by impulse_to_rates().
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "sim_node/behaviour/articulated/dormand_prince.h"
#include "sim_node/behaviour/articulated/dynamics.h"
#include "sim_node/behaviour/articulated/tree.h"
#include "sim_node/model/body_motion.h"

namespace tactus::sim::articulated {

// Sub-step control. In fast motion a step is divided: the end of a whipping chain turns its last joints at hundreds
// of rad/s.
struct Accuracy {
  double position = 1e-5;  // maximum error of a coordinate per sub-step, rad or m
  double rate = 1e-4;      // of a rate, as a share of the fastest rate plus 1 rad/s or m/s
  int max_substeps = 16;   // per step; bounds the cost
};

class ArticulatedSystem {
 public:
  // step_s: length of the following steps; determines which springs and dampers are too stiff for explicit
  // integration. Throws std::invalid_argument: see Tree.
  explicit ArticulatedSystem(const std::vector<LinkDef>& links, double step_s = 0.001, Accuracy accuracy = {});

  // Complete state: after copying it out and in, the system continues bit-identically.
  struct State {
    std::vector<double> positions, rates;  // in the order of Dynamics::evaluate
    double reach_s = 0;                    // length of the next sub-step to try
  };
  const State& state() const { return state_; }
  void set_state(const State& state);

  // Loads of the next step, copied out and in like the state.
  struct SavedLoads {
    Loads loads;
    bool loaded;
  };
  SavedLoads saved_loads() const { return {loads_, loaded_}; }
  void copy_loads(SavedLoads& out) const { out.loads = loads_, out.loaded = loaded_; }
  void set_loads(const SavedLoads& saved_loads);

  // Acts during the next step only. force N at a world point m; moment N m.
  void add_force(int link, const Eigen::Vector3d& force_N, const Eigen::Vector3d& point_m);
  void add_moment(int link, const Eigen::Vector3d& moment_N_m);
  // These hold until they are changed.
  void set_gravity(int link, const Eigen::Vector3d& gravity_m_s2);
  void set_motor(int dof, double effort, double rate);
  void set_friction(int dof, double friction);

  // Accelerations of every dof at the current state. Real-time safe: yes.
  std::span<const double> accelerations();
  // Integrates over h_s. Real-time safe: yes. Costs at most six evaluations for each of max_substeps, plus the same
  // number for rejected ones.
  void step(double h_s);

  // Adds to the rates, or to the coordinates the displacement of these rates over one second.
  void add_rates(std::span<const double> change);
  void displace(std::span<const double> by);

  const Tree& tree() const { return *tree_; }
  // At the current pose, for impulse_to_rates(), response() and jacobian().
  Dynamics& dynamics();
  // The contact solver integrates the springs and dampers of this dof implicitly.
  bool is_stiff(int dof) const { return !passive_[static_cast<std::size_t>(dof)]; }

  BodyMotion motion(int link) const;  // position and orientation: of the centre, relative to rest
  int substeps_last() const { return substeps_; }  // number of sub-steps tried in the last step

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
