// Bullet (libbullet-dev) behind the part of the interface of Solver that checks of mechanics use. Bodies never sleep; all
// else is as Bullet sets it: ten iterations of sequential impulses, in double precision. Joints are constraints.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "sim_node/behaviour/impulse/recovery_report.h"
#include "sim_node/model/body_motion.h"
#include "sim_node/model/manifold.h"
#include "sim_node/settings.gen.h"
#include "tests/bench/peers/earlier_world.h"

namespace tactus::sim::test {

class BulletPeer {
 public:
  static constexpr bool kStartsEarlier = true;
  static constexpr bool kReportsNoContacts = true;  // it has no events of impacts

  // Meshes of moving bodies are their convex hulls. Of the settings only step_s is used.
  BulletPeer(const WorldDef& world, const Settings& settings);
  ~BulletPeer();
  void add_force(int body, const Eigen::Vector3d& force_N, const Eigen::Vector3d& point_m);  // in the next step
  void step();
  std::span<const BodyMotion> bodies() const { return motions_; }
  std::span<const Manifold> contacts() const { return {}; }
  std::span<const Manifold> solved() const { return {}; }
  const impulse::RecoveryReport* report() const { return nullptr; }

 private:
  struct Engine;
  void read();

  EarlierWorld def_;
  double step_s_;
  std::unique_ptr<Engine> engine_;
  std::vector<BodyMotion> motions_;
};

}  // namespace tactus::sim::test
