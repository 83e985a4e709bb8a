// Free bodies, systems of joints and things that never move, and the impulses between them: one step at a time, in
// the order of Guendelman, Bridson and Fedkiw 2003: collisions, velocities, contact, positions. Bodies and links
// are moved by the same sweep. Knows no shapes: contacts are an argument.
#pragma once

#include <span>
#include <vector>

#include "sim_node/behaviour/articulated/articulated_system.h"
#include "sim_node/behaviour/impulse/collisions.h"
#include "sim_node/behaviour/impulse/contact_rows.h"
#include "sim_node/behaviour/impulse/free_body.h"
#include "sim_node/behaviour/impulse/joint_rows.h"
#include "sim_node/behaviour/impulse/layers.h"
#include "sim_node/behaviour/impulse/penalty.h"
#include "sim_node/behaviour/impulse/warm_start.h"
#include "sim_node/model/manifold.h"
#include "sim_node/model/state_archive.h"

namespace tactus::sim::impulse {

struct Law {
  int sweeps = 40;             // most, over all contacts of a step
  double settled_m_s2 = 1e-6;  // sweeps end when no point changes by more in the time of a step: 1e-7 of weight
  double bounce_speed_m_s = 0.02;  // slower impacts do not bounce
  double slack_m = 1e-4;           // overlap that is not repaired
  double repair = 0.2;             // share of a deeper one that is taken back in a step
  double repair_speed_m_s = 0.02;  // and at most so fast
  double shell_m = 0;              // surfaces meet at this gap: what is left of it keeps them apart in truth
  Penalty penalty = {};            // in a shell beyond that gap, instead of collisions that its springs can stop
};

struct Surface {
  double friction = 0.5,
         restitution = 0;  // a pair takes the geometric mean of friction and the smaller restitution
};

// What moves as one, by value: a free body, or all links of a system.
struct UnitState {
  struct {
    Eigen::Vector3d centre_m{0, 0, 0};
    Eigen::Quaterniond orientation{1, 0, 0, 0};
    Eigen::Vector3d velocity_m_s{0, 0, 0}, spin_rad_s{0, 0, 0};
  } body;  // of now
  articulated::ArticulatedSystem::State joints;
};

class World {
 public:
  explicit World(Law law = {}) : law_(law), collisions_({law.bounce_speed_m_s, law.slack_m}) {}

  // Each gives the next number of a body, from 0; a system as many as it has links, in their order.
  int add_fixed();
  int add_free(const FreeBody& body);
  int add_system(articulated::ArticulatedSystem system);
  // Bodies that were added as fixed become the links of a system, in their order.
  void make_system(const std::vector<int>& bodies, articulated::ArticulatedSystem system);
  // Gives the next number of a shape.
  int add_surface(const Surface& surface);

  FreeBody& free_body(int body) { return free_[index(movers_[index(body)].index)]; }
  articulated::ArticulatedSystem& system_of(int body) {
    return systems_[index(movers_[index(body)].index)].system;
  }
  // Acts during the next step.
  void add_force(int body, const Eigen::Vector3d& force_N, const Eigen::Vector3d& point_m);

  // Units: free bodies and systems in the order in which they were added, the free bodies first. Of a body; -1: it
  // does not move. unit_bodies: its bodies, into `out`, appended.
  int units() const { return static_cast<int>(free_.size() + systems_.size()); }
  int unit_of(int body) const;
  // The body that a link's joint hangs it on; -1: the world, or no link.
  int parent_of(int body) const;
  bool is_free(int body) const { return movers_[index(body)].kind == Kind::kFree; }
  void unit_bodies(int unit, std::vector<int>& out) const;
  // Only these units, ascending, are there from now on: the others keep their state, and stand still for what
  // touches them. All of them at first. A step costs what the active ones do. Realtime-safe once its lists have
  // grown.
  void set_active(std::span<const int> units);
  std::span<const int> active_units() const { return active_; }
  // Their bodies, ascending.
  std::span<const int> active_bodies() const { return active_bodies_; }
  // The state of a unit at the end of its last step: put into another world of the same units, it goes on there,
  // whatever the steps of the two. Realtime-safe once the lists of `out` have grown.
  void copy_state(int unit, UnitState& out) const;
  void set_state(int unit, const UnitState& state);

  // contacts: of the present poses, ordered by their shapes, with gaps (negative depth) out to where a step may
  // lead; each point's normal_force_N is filled in, mean over the step, blows included. Deterministic.
  // Realtime-safe once its lists have grown.
  void step(std::span<Manifold> contacts, double h_s);

  // Acts during the next step, N m.
  void add_torque(int body, const Eigen::Vector3d& torque_N_m);
  // All that the next steps depend on. Throws BadState when what is read does not fit; this is then half changed.
  void archive(StateArchive& a);

  // All that a step changes of the active units, so that it can be taken back.
  struct Kept {
    std::vector<FreeBody> free;
    std::vector<articulated::ArticulatedSystem::State> states;
    std::vector<articulated::ArticulatedSystem::Burden> burdens;
    std::vector<JointMemory> memories;
    std::vector<BodyMotion> motions;  // of the active bodies
    WarmStart warm;
  };
  // Realtime-safe once the lists of `out` have grown. The active units must be the same until it is taken back.
  void keep(Kept& out);
  void take_back(const Kept& kept);
  // What acted in the step after which this was kept acts in the next one too.
  void load_again(const Kept& kept);
  // Puts a unit where it was, at rest.
  void hold(int unit, const Kept& kept);
  // Moves what overlaps apart, along the shortest way that the contacts leave and as inertia divides it: positions
  // alone, no speed comes of it. contacts: of the present poses; overlaps deeper than most_m are left alone.
  void separate(std::span<const Manifold> contacts, double most_m);

  // What may be set between steps; each holds from the next one on. Velocities of a link are those that it has at
  // the instant when its joints begin to hold: the others take their share, as from a blow (Featherstone 2008,
  // section 11.7). False: the body is not free, or has no such axis.
  void set_gravity(int body, const Eigen::Vector3d& gravity_m_s2);
  bool set_mass(int body, double mass_kg);  // the inertia in proportion
  bool set_pose(int body, const Eigen::Vector3d& centre_m, const Eigen::Quaterniond& orientation);
  void set_velocity(int body, const Eigen::Vector3d& velocity_m_s);
  void set_spin(int body, const Eigen::Vector3d& spin_rad_s);
  void set_surface(int shape, const Surface& surface) { surfaces_[index(shape)] = surface; }
  const Surface& surface(int shape) const { return surfaces_[index(shape)]; }
  // axis: of the joint that carries this link, as its LinkDef numbers them.
  bool set_motor(int body, int axis, double effort, double rate);
  bool set_joint_friction(int body, int axis, double friction);
  // Speed that a unit impulse along n at the point gives to that point, 1/kg; joints included.
  double mobility(int body, const Eigen::Vector3d& point_m, const Eigen::Vector3d& n);

  // After a step (or none): velocities are the means over it. position: the centre of mass.
  std::span<const BodyMotion> motions() const { return motions_; }
  int sweeps_last() const { return sweeps_; }
  bool moves(int body) const { return movers_[index(body)].kind != Kind::kFixed; }

 private:
  enum class Kind { kFixed, kFree, kLink };
  struct Mover {
    Kind kind = Kind::kFixed;
    int index = 0, link = 0;
  };
  struct System {
    articulated::ArticulatedSystem system;
    JointMemory memory;
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
  void ask(double h);
  void tell(std::span<Manifold> contacts, double h) const;
  void weigh_anew(std::span<const Manifold> contacts);
  void separate(std::size_t system);
  void refresh(System& system);
  int dof_of(int body, int axis) const;
  static void place(BodyMotion& m, const BodyMotion& at);
  void sweep(double h_s);
  void finish(double h);
  void finish(std::size_t system, double h);
  int mover_number(const Mover& m) const;
  const Mover& mover(int body) const {
    static constexpr Mover kStill{};
    return present_[index(body)] ? movers_[index(body)] : kStill;
  }

  Law law_;
  std::vector<Mover> movers_;
  std::vector<char> present_;                // of each body: its unit is active
  std::vector<int> active_, active_bodies_;  // ascending; empty before the first step
  std::vector<int> body_of_;                 // of each free body
  bool chosen_ = false;                      // else all are active
  std::vector<Surface> surfaces_;
  std::vector<FreeBody> free_;
  std::vector<System> systems_;
  std::vector<BodyMotion> motions_;
  ContactRows rows_;
  std::vector<JointRow> joints_;
  Collisions collisions_;
  WarmStart warm_;
  Layers layers_;
  std::vector<Flight> flights_;             // of free bodies
  std::vector<double> lasts_s_;             // of each: from the middle of the step before to that of this one
  std::vector<std::size_t> first_rate_{0};  // of each system, and one past the last
  Velocities velocity_, drift_, aside_;
  std::vector<double> scratch_;
  std::vector<int> stirred_;  // per mover plus one: the visit that last changed it
  int sweeps_ = 0;
};

}  // namespace tactus::sim::impulse
