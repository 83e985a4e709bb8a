// The force on each contact of a touch model, from its accumulated impulses. Pure.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <vector>

#include "sync/degradation/deadband.h"
#include "sync/time/time.h"

namespace tactus::sync {

// A touch model carries the impulse on each contact since its begin (touch_applied_t). The impulse of a contact that lasts
// grows without limit, so a share of it is no measure of a change: a deadband compares the force, which is the difference of
// the impulses of two models over the time between them.
class TouchForces {
 public:
  // Appends a signal of force for each contact in `signals`, those of a whole model at t: N, in the world frame, the mean since
  // the model before. 0: for a contact without an impulse, and for one in its first model. While the world stands still, or for
  // a model that is older than one before, the force stays the same.
  void append(std::vector<Signal>& signals, SimTime t);

 private:
  struct Contact {
    SimTime time{};
    Eigen::Vector3d impulse_N_s = Eigen::Vector3d::Zero(), force_N = Eigen::Vector3d::Zero();
    bool present = false, pushed = false;  // in this model; with an impulse
  };
  static void follow(Contact& contact, const Eigen::Vector3d& impulse_N_s, SimTime t);

  std::map<std::int64_t, Contact> contacts_;  // by contact id; only those of the newest model
};

}  // namespace tactus::sync
