// The bodies of a world and the laws that move them: one step of a world at a time. By impulses, with contacts that see
// gaps; or by ODE, which stays behind this header.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "sim_node/model/body_motion.h"
#include "sim_node/behaviour/impulse/scene_settings.h"
#include "sim_node/behaviour/impulse/step_report.h"
#include "sim_node/contacts/friction_maps.h"
#include "sim_node/model/manifold.h"
#include "sim_node/model/world_def.h"
#include "sim_node/settings.gen.h"
#include "sim_node/model/state_archive.h"

namespace tactus::sim {

class ImpulseSolver;

class Solver {
 public:
  // Throws std::runtime_error with one sentence when a body cannot be simulated.
  Solver(const WorldDef& world, const Settings& settings);
  ~Solver();
  Solver(const Solver&) = delete;
  Solver& operator=(const Solver&) = delete;

  // Acts during the next step, N, at a point of the world, m. Bodies that never move ignore it.
  void add_force(int body, const Eigen::Vector3d& force_N, const Eigen::Vector3d& point_m);

  // The same for a torque about the centre of mass, N m.
  void add_torque(int body, const Eigen::Vector3d& torque_N_m);

  // What may be set while the world runs; each holds from the next step on. Values are not checked here. A body that does
  // not move has no mass and no velocity to set, one on a joint no pose and no mass; false: it has none.
  bool apply(const impulse::SceneChange& change);  // any of them but pose, velocity and spin
  void set_gravity(const Eigen::Vector3d& gravity_m_s2);
  bool set_mass(int body, double mass_kg);  // the inertia in proportion
  bool set_pose(int body, const Eigen::Isometry3d& pose);
  bool set_velocity(int body, const Eigen::Vector3d& velocity_m_s);  // of the centre of mass
  bool set_spin(int body, const Eigen::Vector3d& spin_rad_s);
  void set_friction(int body, double friction);
  void set_restitution(int body, double restitution);
  bool set_motor(const std::string& joint, int axis, double effort, double velocity);
  bool set_joint_friction(const std::string& joint, int axis, double friction);

  // All that the next steps depend on. Throws BadState when what is read does not fit; this is then half changed.
  void archive(StateArchive& a);

  // One step: solves the contacts found last, moves the bodies, finds the contacts of the new poses.
  // Deterministic: the same steps from the same world are the same to the bit. Not for two threads at once.
  // Realtime-safe once its lists have grown.
  void step();

  // Of every body of the world, tools and fixed bodies included (they stand still).
  std::span<const BodyMotion> bodies() const;
  // Contacts of the present poses, and those of the step before with the force that each point carried; both ordered.
  std::span<const Manifold> contacts() const;
  std::span<const Manifold> solved() const;
  // Speed that a unit impulse along n at the point gives to that point, 1/kg: of a link with its joints, where impulses
  // solve.
  double mobility(int body, const Eigen::Vector3d& point_m, const Eigen::Vector3d& n);
  // What it took that nothing overlaps; of ODE none.
  const impulse::StepReport* report() const;
  // How often the engine said that it could not solve something, since the start.
  std::int64_t complaints() const;
  // How far apart the joints have come at most, m.
  double largest_joint_gap_m() const;

 private:
  struct Engine;
  struct Inert {  // in body axes; zero for what never moves
    Eigen::Vector3d centre_in_body_m;
    Eigen::Matrix3d inverse_inertia;
    Eigen::Vector3d gravity_m_s;  // speed that gravity adds in a step
  };
  void start(const WorldDef& world);
  void read_bodies();
  void back_off(Manifold& contact, bool is_new);
  void join(Manifold& contact);

  std::unique_ptr<ImpulseSolver> impulse_;  // null when ODE solves
  std::unique_ptr<Engine> engine_;          // null when impulses do
  Settings settings_;
  std::vector<double> friction_, restitution_;  // per shape
  std::unique_ptr<const FrictionMaps> friction_maps_;
  std::vector<int> body_of_;                    // per shape
  std::vector<bool> falls_;                     // per body: gravity acts on it
  std::vector<Inert> inert_;
  std::vector<Eigen::Vector3d> fall_m_s_;  // what gravity and forces add to each body's speed in the next step
  std::vector<Eigen::Vector3d> shift_m_;   // by which each body was put back in this step
  std::vector<BodyMotion> motions_;
  std::vector<Manifold> contacts_, solved_;
  std::int64_t steps_ = 0;
};

}  // namespace tactus::sim
