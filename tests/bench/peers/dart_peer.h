// DART (libdart-dev) behind the part of the interface of Solver that checks of mechanics use: bodies of boxes and balls, joints
// in joint coordinates, DART's own detector and its default solver.
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

class DartPeer {
 public:
  static constexpr bool kStartsEarlier = true;
  static constexpr bool kReportsNoContacts = true;

  // Shapes are boxes, balls and planes, which are boxes of 200 m. Of the settings only step_s is used. Throws
  // std::runtime_error for other shapes.
  DartPeer(const WorldDef& world, const Settings& settings);
  ~DartPeer();
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
