// The bodies and joints of a scene, moved by impulses in one world, with contacts that see gaps: nothing of ODE.
// What Solver does when the setting `solver` is impulse.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "sim_node/behaviour/impulse/advance.h"
#include "sim_node/behaviour/impulse/body_frames.h"
#include "sim_node/behaviour/impulse/world.h"
#include "sim_node/collision/contact_finder.h"
#include "sim_node/scene/world_def.h"
#include "sim_node/settings.gen.h"
#include "sim_node/state/state_archive.h"

namespace tactus::sim {

// How far each body reaches from its centre of mass.
std::vector<impulse::Extent> extents_of(const WorldDef& world);

// Contacts of the shapes of a scene, for bodies as an impulse world moves them.
class SceneContacts : public impulse::ContactSource {
 public:
  SceneContacts(const WorldDef& world, const Settings& settings)
      : frames_(world), bodies_(frames_.at_start(world)), finder_(world, settings) {}
  void find(std::span<const BodyMotion> motions, std::span<const int> active_bodies, double h_s,
            std::vector<Manifold>& out) override;
  const impulse::BodyFrames& frames() const { return frames_; }
  // Of every body, as it was when contacts were last sought.
  std::span<const BodyMotion> bodies() const { return bodies_; }

 private:
  impulse::BodyFrames frames_;
  std::vector<BodyMotion> bodies_;
  ContactFinder finder_;
};

class ImpulseSolver {
 public:
  // Throws std::runtime_error with one sentence when the scene cannot be simulated so.
  ImpulseSolver(const WorldDef& world, const Settings& settings);

  void add_force(int body, const Eigen::Vector3d& force_N, const Eigen::Vector3d& point_m) {
    world_->add_force(body, force_N, point_m);
  }
  void add_torque(int body, const Eigen::Vector3d& torque_N_m) { world_->add_torque(body, torque_N_m); }
  // Everything is as Solver has it. Realtime-safe once its lists have grown.
  void step(double h_s);
  std::span<const BodyMotion> bodies() const { return bodies_; }
  std::span<const Manifold> contacts() const { return contacts_; }
  std::span<const Manifold> solved() const { return solved_; }
  const impulse::StepReport& report() const { return report_; }
  // Speed that a unit impulse along n at the point gives to that point, 1/kg; joints included.
  double mobility(int body, const Eigen::Vector3d& point_m, const Eigen::Vector3d& n) {
    return world_->mobility(body, point_m, n);
  }

  void set_gravity(const Eigen::Vector3d& gravity_m_s2);
  bool set_mass(int body, double mass_kg);
  bool set_pose(int body, const Eigen::Isometry3d& pose);
  bool set_velocity(int body, const Eigen::Vector3d& velocity_m_s);
  bool set_spin(int body, const Eigen::Vector3d& spin_rad_s);
  void set_friction(int body, double friction);
  void set_restitution(int body, double restitution);
  bool set_motor(const std::string& joint, int axis, double effort, double velocity);
  bool set_joint_friction(const std::string& joint, int axis, double friction);

  void archive(StateArchive& a);

 private:
  // The link that a joint carries; from the other side its axes are numbered the other way round.
  struct Joint {
    std::string name;
    int body;
    bool swapped;
  };
  const Joint* joint(const std::string& name) const;
  int axis_of(const Joint& j, int axis) const { return j.swapped ? 1 - axis : axis; }
  void read();
  void look();

  std::unique_ptr<impulse::World> world_;
  SceneContacts source_;
  impulse::Advance advance_;
  impulse::StepReport report_;
  double step_s_;
  std::vector<bool> falls_;
  std::vector<int> body_of_;  // per shape
  std::vector<Eigen::Vector3d> centre_in_body_m_;
  std::vector<Joint> joints_;
  std::vector<BodyMotion> bodies_;
  std::vector<Manifold> contacts_, solved_;
};

}  // namespace tactus::sim
