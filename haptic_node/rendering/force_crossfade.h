// When other surfaces begin to bind while the hand is pressed, the force goes over from the old set to the new
// within the recovery time (Mark et al. 1996), from where it was. Nothing else is smoothed: the first touch, the
// release, and whatever happens while the same surfaces bind pass as they are, so real contact stays as sharp as
// it is.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "haptic_node/contact/surfaces.h"

namespace tactus::haptic {

class ForceCrossfade {
 public:
  // A change of less than step_N_s per second is passed at once.
  ForceCrossfade(double recovery_time_s, double step_N_s) : time_s_(recovery_time_s), step_N_s_(step_N_s) {
    last_set_.reserve(kMaxHalfSpaces);
  }

  // One tick: the force of the surfaces as they bind now, N; returns the force to render, N. Realtime-safe: yes.
  Eigen::Vector3d step(std::span<const Surface> surfaces, const Eigen::Vector3d& force_N, double dt);
  // The next step is one in which other surfaces bind, whatever binds: the rendering has changed.
  void renew() { renewed_ = true; }

 private:
  bool changed(std::span<const Surface> surfaces);

  double time_s_, step_N_s_;
  std::vector<std::int64_t> last_set_;  // contacts that bound in the last tick, in the order of the list
  Eigen::Vector3d last_ = Eigen::Vector3d::Zero();       // rendered, N
  Eigen::Vector3d remainder_ = Eigen::Vector3d::Zero();  // of the old set's force that is still to go, N
  double left_s_ = 0;                                    // until it is gone
  bool renewed_ = false;
};

}  // namespace tactus::haptic
