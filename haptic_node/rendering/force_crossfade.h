// Crossfade of the force when other surfaces begin to bind while the hand is pressed: from the old set to the new
// within the recovery time (Mark et al. 1996), starting at the current force. Nothing else is smoothed: the first
// touch, the release and every change while the same surfaces bind pass unchanged, so real contact stays sharp.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "haptic_node/contact/surfaces.h"

namespace tactus::haptic {

class ForceCrossfade {
 public:
  // A change of less than step_N_s per second passes immediately.
  ForceCrossfade(double recovery_time_s, double step_N_s) : time_s_(recovery_time_s), step_N_s_(step_N_s) {
    last_set_.reserve(kMaxHalfSpaces);
  }

  // One tick. Input: the force of the surfaces that bind now, N. Returns the force to render, N. Realtime-safe:
  // yes.
  Eigen::Vector3d step(std::span<const Surface> surfaces, const Eigen::Vector3d& force_N, double dt);
  // Treats the next step as a change of the binding surfaces, because the rendering method has changed.
  void restart() { restart_pending_ = true; }
  // Resets the force to zero: nothing is pressed.
  void reset();

 private:
  bool binding_set_changed(std::span<const Surface> surfaces);

  double time_s_, step_N_s_;
  std::vector<std::int64_t> last_set_;                   // contacts that bound in the last tick, in list order
  Eigen::Vector3d last_ = Eigen::Vector3d::Zero();       // rendered, N
  Eigen::Vector3d remainder_ = Eigen::Vector3d::Zero();  // remaining part of the force of the old set, N
  double remaining_s_ = 0;                               // time until it is zero
  bool restart_pending_ = false;
};

}  // namespace tactus::haptic
