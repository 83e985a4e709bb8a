// The bodies and joints of a scene in one impulse world, with contacts that have gaps; without ODE. Implements Solver
// for the setting `solver` = impulse.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "sim_node/behaviour/impulse/adaptive_stepper.h"
#include "sim_node/behaviour/impulse/body_frames.h"
#include "sim_node/behaviour/impulse/scene_settings.h"
#include "sim_node/behaviour/impulse/world.h"
#include "sim_node/contacts/contact_finder.h"
#include "sim_node/model/state_archive.h"
#include "sim_node/model/world_def.h"
#include "sim_node/settings.gen.h"

namespace tactus::sim {

// Extent of each body from its centre of mass.
std::vector<impulse::Extent> extents_of(const WorldDef& world);

// Contacts of the shapes of a scene, for body motions of an impulse world.
class SceneContacts : public impulse::ContactSource {
 public:
  SceneContacts(const WorldDef& world, const Settings& settings, const std::shared_ptr<MeshTrees>& trees = nullptr)
      : frames_(world), bodies_(frames_.at_start(world)), finder_(world, settings, trees) {}
  void find(std::span<const BodyMotion> motions, std::span<const int> active_bodies, double h_s,
            std::vector<Manifold>& out) override;
  const impulse::BodyFrames& frames() const { return frames_; }
  std::size_t shapes() const { return finder_.shapes(); }
  // Motions of all bodies at the last contact search.
  std::span<const BodyMotion> bodies() const { return bodies_; }

 private:
  impulse::BodyFrames frames_;
  std::vector<BodyMotion> bodies_;
  ContactFinder finder_;
};

class ImpulseSolver {
 public:
  // Throws std::runtime_error with one sentence when the scene cannot be simulated this way.
  ImpulseSolver(const WorldDef& world, const Settings& settings);

  void add_force(int body, const Eigen::Vector3d& force_N, const Eigen::Vector3d& point_m) {
    world_->add_force(body, force_N, point_m);
  }
  void add_torque(int body, const Eigen::Vector3d& torque_N_m) { world_->add_torque(body, torque_N_m); }
  // The same interface as Solver. Real-time safe once its lists have grown.
  void step(double h_s);
  std::span<const BodyMotion> bodies() const { return bodies_; }
  std::span<const Manifold> contacts() const { return contacts_; }
  std::span<const Manifold> solved() const { return solved_; }
  const impulse::RecoveryReport& report() const { return report_; }
  // Speed of the point along n per unit impulse along n at the point, 1/kg; joints included.
  double mobility(int body, const Eigen::Vector3d& point_m, const Eigen::Vector3d& n) {
    return world_->mobility(body, point_m, n);
  }

  bool apply(const impulse::SceneChange& change);
  bool set_pose(int body, const Eigen::Isometry3d& pose);
  bool set_velocity(int body, const Eigen::Vector3d& velocity_m_s);
  bool set_spin(int body, const Eigen::Vector3d& spin_rad_s);

  void archive(StateArchive& a);

 private:
  void read();
  void detect_contacts();

  std::unique_ptr<impulse::World> world_;
  SceneContacts source_;
  impulse::AdaptiveStepper stepper_;
  impulse::RecoveryReport report_;
  double step_s_;
  impulse::SceneSettings scene_;
  std::size_t shapes_;
  std::vector<BodyMotion> bodies_;
  std::vector<Manifold> contacts_, solved_;
};

}  // namespace tactus::sim
