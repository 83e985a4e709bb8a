// Tasks with a known outcome for rigid-body engines, each reduced to one error. Worlds, masses and durations follow
// SimBenchmark (Kang and Hwangbo 2018, https://leggedrobotics.github.io/SimBenchmark), except for the articulated body and for
// shorter durations.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "sim_node/model/body_motion.h"
#include "sim_node/model/world_def.h"

namespace tactus::bench {

// A world in an engine.
class Peer {
 public:
  virtual ~Peer() = default;
  virtual void add_force(int body, const Eigen::Vector3d& force_N) = 0;  // at its centre, in the next step
  virtual void step() = 0;
  virtual std::span<const sim::BodyMotion> bodies() const = 0;
};
using MakePeer = std::function<std::unique_ptr<Peer>(const sim::WorldDef& world, double step_s)>;

struct PeerResult {
  double error = 0;        // in the unit of the task; NaN when a pose is not finite
  double step_us = 0;      // mean cost of a step
  double simulated_s = 0;  // shorter than the task when the budget was spent
};

struct PeerTask {
  std::string name, unit, truth;  // truth: the known outcome
  double seconds = 1;
  std::function<PeerResult(const MakePeer& make, double step_s, double seconds, double budget_s)> run;
};

const std::vector<PeerTask>& peer_tasks();

}  // namespace tactus::bench
