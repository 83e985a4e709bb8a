// Steps the bodies of a world with one contact law: by impulses, with contacts that have gaps, or by ODE, which is
// hidden behind this header.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "sim_node/behaviour/impulse/recovery_report.h"
#include "sim_node/behaviour/impulse/scene_settings.h"
#include "sim_node/contacts/friction_maps.h"
#include "sim_node/model/body_motion.h"
#include "sim_node/model/manifold.h"
#include "sim_node/model/state_archive.h"
#include "sim_node/model/world_def.h"
#include "sim_node/settings.gen.h"

namespace tactus::sim {

class ImpulseSolver;

class Solver {
 public:
  // Throws std::runtime_error with one sentence when a body cannot be simulated.
  Solver(const WorldDef& world, const Settings& settings);
  ~Solver();
  Solver(const Solver&) = delete;
  Solver& operator=(const Solver&) = delete;

  // Applies a force during the next step at a point in the world. Static bodies ignore it.
  void add_force(int body, const Eigen::Vector3d& force_N, const Eigen::Vector3d& point_m);

  // The same for a torque about the centre of mass, N m.
  void add_torque(int body, const Eigen::Vector3d& torque_N_m);

  // Changes of a running world, effective from the next step on. Values are not checked here. Return false when the
  // property does not exist: a static body has no mass and no velocity, a jointed body has no pose and no mass.
  bool apply(const impulse::SceneChange& change);  // any change but pose, velocity and spin
  bool set_pose(int body, const Eigen::Isometry3d& pose);
  bool set_velocity(int body, const Eigen::Vector3d& velocity_m_s);  // of the centre of mass
  bool set_spin(int body, const Eigen::Vector3d& spin_rad_s);

  // Archives all state of the next steps. Throws InvalidState when the data does not fit; the solver is then
  // partly changed.
  void archive(StateArchive& a);

  // One step: solves the contacts found last, moves the bodies, finds the contacts of the new poses. Deterministic:
  // equal steps from equal worlds are bit-identical. Not thread-safe. Real-time safe once its lists have grown.
  void step();

  // Motion of every body, including tools and static bodies, which do not move.
  std::span<const BodyMotion> bodies() const;
  // Contacts of the current poses, and contacts of the previous step with the force of each point; both ordered.
  std::span<const Manifold> contacts() const;
  std::span<const Manifold> solved() const;
  // Speed of the point along n per unit impulse along n at the point, 1/kg. The impulse solver includes the joints
  // of a link.
  double mobility(int body, const Eigen::Vector3d& point_m, const Eigen::Vector3d& n);
  // Statistics of the penetration recovery; null for ODE.
  const impulse::RecoveryReport* report() const;

 private:
  struct Engine;
  struct BodyInertia {  // in body axes; zero for static bodies
    Eigen::Vector3d centre_in_body_m;
    Eigen::Matrix3d inverse_inertia;
    Eigen::Vector3d gravity_m_s;  // speed that gravity adds per step
  };
  void start(const WorldDef& world);
  void set_gravity(const Eigen::Vector3d& gravity_m_s2);
  bool set_mass(int body, double mass_kg);  // scales the inertia
  void read_bodies();
  void move_back(Manifold& contact, bool is_new);
  void add_contact_joint(Manifold& contact);

  std::unique_ptr<ImpulseSolver> impulse_;  // null when ODE solves
  std::unique_ptr<Engine> engine_;          // null when impulses solve
  Settings settings_;
  std::vector<double> friction_, restitution_;  // per shape
  std::unique_ptr<const FrictionMaps> friction_maps_;
  std::vector<int> body_of_;                    // per shape
  std::vector<bool> has_gravity_;               // per body: affected by gravity
  std::vector<BodyInertia> inertias_;
  std::vector<Eigen::Vector3d> free_fall_m_s_;  // speed that gravity and forces add to each body in the next step
  std::vector<Eigen::Vector3d> moved_back_m_;   // displacement by which each body was moved back in this step
  std::vector<BodyMotion> motions_;
  std::vector<Manifold> contacts_, solved_;
  std::int64_t steps_ = 0;
};

}  // namespace tactus::sim
