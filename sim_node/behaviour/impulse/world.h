// Free bodies, systems of joints and static bodies, with impulses between them. One step follows Guendelman, Bridson
// and Fedkiw 2003: collisions, velocities, contact, positions. The same sweep solves bodies and links. Independent of
// shapes: contacts are an argument.
#pragma once

#include <limits>
#include <span>
#include <vector>

#include "sim_node/behaviour/articulated/articulated_system.h"
#include "sim_node/behaviour/impulse/collisions.h"
#include "sim_node/behaviour/impulse/contact_rows.h"
#include "sim_node/behaviour/impulse/floating_islands.h"
#include "sim_node/behaviour/impulse/free_body.h"
#include "sim_node/behaviour/impulse/island_solver.h"
#include "sim_node/behaviour/impulse/joint_rows.h"
#include "sim_node/behaviour/impulse/layers.h"
#include "sim_node/behaviour/impulse/penalty.h"
#include "sim_node/behaviour/impulse/warm_start.h"
#include "sim_node/model/manifold.h"
#include "sim_node/model/state_archive.h"

namespace tactus::sim::impulse {

struct ContactLaw {
  int sweeps = 40;             // maximum, over all contacts of a step
  double convergence_m_s2 = 1e-6;  // sweeps end when no point changes by more per time of a step: 1e-7 of weight
  double bounce_speed_m_s = 0.02;  // slower impacts do not bounce
  double slop_m = 1e-4;            // overlap that is not corrected
  double correction_share = 0.2;   // share of a deeper overlap that is corrected per step
  double max_correction_speed_m_s = 0.02;  // upper limit of the correction speed
  double shell_m = 0;              // surfaces meet at this gap, so that residuals stay free of overlap
  Penalty penalty = {};            // in a shell beyond that gap, in place of collisions that its springs can stop
};

struct Surface {
  double friction = 0.5,
         restitution = 0;  // a pair uses the geometric mean of friction and the smaller restitution
  RoundShape round = {};   // in the axes of the body at rest
};

// State of a unit, by value: a free body, or all links of a system.
struct UnitState {
  struct {
    Eigen::Vector3d centre_m{0, 0, 0};
    Eigen::Quaterniond orientation{1, 0, 0, 0};
    Eigen::Vector3d velocity_m_s{0, 0, 0}, spin_rad_s{0, 0, 0};
  } body;  // current
  articulated::ArticulatedSystem::State joints;
};

class World {
 public:
  explicit World(ContactLaw law = {}) : law_(law), collisions_({law.bounce_speed_m_s, law.slop_m, law.shell_m}) {}

  // Each returns the next body index, from 0.
  int add_fixed();
  int add_free(const FreeBody& body);
  // Turns bodies that were added as fixed into the links of a system, in order.
  void make_system(const std::vector<int>& bodies, articulated::ArticulatedSystem system);
  // Returns the next shape index.
  int add_surface(const Surface& surface);

  FreeBody& free_body(int body) { return free_[index(movers_[index(body)].index)]; }
  articulated::ArticulatedSystem& system_of(int body) {
    return systems_[index(movers_[index(body)].index)].system;
  }
  // Acts during the next step.
  void add_force(int body, const Eigen::Vector3d& force_N, const Eigen::Vector3d& point_m);

  // Units are the free bodies, then the systems, each in the order of addition. unit_of: -1 for a static body.
  // unit_bodies: appends the bodies of a unit to `out`.
  int units() const { return static_cast<int>(free_.size() + systems_.size()); }
  int unit_of(int body) const;
  // The body that a link's joint connects it to; -1: the world, or no link.
  int parent_of(int body) const;
  bool is_free(int body) const { return movers_[index(body)].kind == Kind::kFree; }
  void unit_bodies(int unit, std::vector<int>& out) const;
  // Activates only these units, ascending. Others keep their state and act as static bodies. Initially all are
  // active. The cost of a step depends on the active units only. Real-time safe once its lists have grown.
  void set_active(std::span<const int> units);
  std::span<const int> active_units() const { return active_; }
  // Their bodies, ascending.
  std::span<const int> active_bodies() const { return active_bodies_; }
  // The state of a unit at the end of its last step. In another world with the same units it continues unchanged,
  // also with different step lengths. Real-time safe once the lists of `out` have grown.
  void copy_state(int unit, UnitState& out) const;
  void set_state(int unit, const UnitState& state);

  // contacts: of the current poses, ordered by their shapes, with gaps (negative depth) within the range of a step.
  // Sets each point's normal_force_N, the mean over the step, impacts included. Deterministic. Real-time safe once
  // its lists have grown.
  void step(std::span<Manifold> contacts, double h_s);

  // Acts during the next step, N m.
  void add_torque(int body, const Eigen::Vector3d& torque_N_m);
  // Archives all state of the next steps. Throws InvalidState when the data does not fit; the world is then partly
  // changed.
  void archive(StateArchive& a);

  // Everything that a step changes in the active units, to take it back.
  struct SavedStep {
    std::vector<FreeBody> free;
    std::vector<articulated::ArticulatedSystem::State> states;
    std::vector<articulated::ArticulatedSystem::SavedLoads> saved_loads;
    std::vector<JointImpulses> memories;
    std::vector<BodyMotion> motions;  // of the active bodies
    WarmStart warm;
  };
  // save() is real-time safe once the lists of `out` have grown. The active units must not change until restore().
  void save(SavedStep& out);
  void restore(const SavedStep& saved);
  // Applies the loads of the saved step to the next step too.
  void restore_loads(const SavedStep& saved);
  // Resets a unit to its saved pose. It keeps its momentum, except that which gravity added in the step of step_s.
  void hold(int unit, const SavedStep& saved, double step_s);
  // Resolves the approach of overlapping surfaces as an impact without restitution and friction: impulses act on both
  // sides, so that momentum is constant, and take at most max_energy_J. contacts: of the current poses; those that are
  // not deeper than min_overlap_m are ignored.
  void stop_approach(std::span<const Manifold> contacts, double min_overlap_m,
                     double max_energy_J = std::numeric_limits<double>::max());
  // Resolves overlaps by the smallest displacement that the contacts allow, weighted by inertia. Changes positions
  // only; velocities change by a small common rotation rate, where floating bodies would lose angular momentum. contacts:
  // of the current poses. Overlaps deeper than max_overlap_m are ignored. Returns the energy that free bodies gain: by their
  // weight, by their spin about turned axes of inertia, and by that rotation rate.
  double separate(std::span<const Manifold> contacts, double max_overlap_m);
  // Sets the velocities of free bodies in motions() to those at the middle of a step of h_s that ends now. Call it after
  // the last part of a divided step: the velocities belong to the middle of that part.
  void centre_velocities(double h_s);

  // Changes between steps, in force from the next step on. The velocity of a link acts like an impulse: the other
  // joints take their share (Featherstone 2008, section 11.7). Functions return false when the body is not free or
  // has no such axis.
  void set_gravity(int body, const Eigen::Vector3d& gravity_m_s2);
  bool set_mass(int body, double mass_kg);  // scales the inertia
  bool set_pose(int body, const Eigen::Vector3d& centre_m, const Eigen::Quaterniond& orientation);
  void set_velocity(int body, const Eigen::Vector3d& velocity_m_s);
  void set_spin(int body, const Eigen::Vector3d& spin_rad_s);
  void set_surface(int shape, const Surface& surface) { surfaces_[index(shape)] = surface; }
  const Surface& surface(int shape) const { return surfaces_[index(shape)]; }
  // axis: of the joint that moves this link, in the order of its LinkDef.
  bool set_motor(int body, int axis, double effort, double rate);
  bool set_joint_friction(int body, int axis, double friction);
  // Speed of the point along n per unit impulse along n at the point, 1/kg; joints included.
  double mobility(int body, const Eigen::Vector3d& point_m, const Eigen::Vector3d& n);

  // After a step, velocities are the means over it. position: the centre of mass.
  std::span<const BodyMotion> motions() const { return motions_; }
  int sweeps_last() const { return sweeps_; }
  // Convergence of the contacts in the last step.
  const IslandSolver::Result& convergence() const { return convergence_; }
  bool moves(int body) const { return movers_[index(body)].kind != Kind::kFixed; }

 private:
  enum class Kind { kFixed, kFree, kLink };
  struct Mover {
    Kind kind = Kind::kFixed;
    int index = 0, link = 0;
  };
  struct System {
    articulated::ArticulatedSystem system;
    JointImpulses memory;
    std::vector<int> bodies;  // of its links
    bool has_rows = false, touched = false;
  };
  static std::size_t index(int i) { return static_cast<std::size_t>(i); }
  void activate_all();
  void add_drift();
  void start_velocities(std::span<const Manifold> contacts, double h);
  void build_rows(std::span<const Manifold> contacts, double h);
  void build_joints(double h);
  void couple(ContactPoint& p, int system, int link_a, int link_b, const Eigen::Vector3d& point_m);
  void set_required_speeds(double h);
  double followed_bend_m(const ContactPoint& p, double h) const;
  void write_results(std::span<Manifold> contacts, double h) const;
  void update_inertia(std::span<const Manifold> contacts);
  void limit_stopping(double max_energy_J);
  double displace_free(int unit);
  double restore_spin();
  void separate_links(std::size_t system);
  void refresh(System& system);
  int dof_of(int body, int axis) const;
  static void place(BodyMotion& m, const BodyMotion& at);
  void sweep(double h_s);
  void limit_warm_start();
  void shift_arms();
  void correct_positions(double h_s);
  void finish(double h);
  void finish(std::size_t system, double h);
  int mover_number(const Mover& m) const;
  const Mover& mover(int body) const {
    static constexpr Mover kStill{};
    return present_[index(body)] ? movers_[index(body)] : kStill;
  }

  ContactLaw law_;
  std::vector<Mover> movers_;
  std::vector<char> present_;                // per body: its unit is active
  std::vector<int> active_, active_bodies_;  // ascending; empty before the first step
  std::vector<int> body_of_;                 // per free body
  bool has_active_set_ = false;              // false: all units are active
  std::vector<Surface> surfaces_;
  std::vector<FreeBody> free_;
  std::vector<System> systems_;
  std::vector<BodyMotion> motions_;
  ContactRows rows_;
  std::vector<JointRow> joints_;
  Collisions collisions_;
  WarmStart warm_;
  ContactLayers layers_;
  std::vector<FreeMotion> free_motions_;    // of free bodies
  std::vector<double> force_time_s_;        // per free body: time from the middle of the previous step to the middle of this one
  std::vector<std::size_t> first_rate_{0};  // of each system, and one past the last
  IslandSolver islands_;
  IslandSolver::Result convergence_;
  bool has_corrections_ = false;  // of positions, in this step
  std::vector<Manifold> overlapping_;
  std::vector<double> end_gap_m_, lift_;  // per contact point, while positions are corrected
  FloatingIslands floating_;
  std::vector<Eigen::Vector3d> lost_kg_m2_s_;  // per twist: angular momentum that a correction of positions took
  Velocities velocity_, drift_, position_offset_;
  Velocities before_contacts_;  // velocities without the impulses of the sweeps
  std::vector<double> scratch_;
  std::vector<int> last_change_;  // per mover plus one: counter value of its last change
  int sweeps_ = 0;
};

}  // namespace tactus::sim::impulse
