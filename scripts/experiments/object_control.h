// A person who brings an object to a place, with a hand that is coupled to the object. The person estimates the
// place of the hand, and the gap between hand and object, from the senses, and moves the hand so that the object
// arrives. Pure.
#pragma once

#include <cstdint>

#include "scripts/simulated_player/observer/delayed_kalman.h"
#include "scripts/simulated_player/observer/hand.h"
#include "scripts/simulated_player/observer/noise_stream.h"
#include "scripts/simulated_player/observer/percept_channel.h"

namespace tactus::experiments {

constexpr double kControlStep_s = 0.005;

// Feedback of the hand for the preferred pace of a person.
observer::Vector paced_feedback(const observer::PlayerParameters& player);

class ObjectControl {
 public:
  // start_m: of hand and object, relative to the goal. gap_m2_s: diffusion of the gap that the person expects.
  ObjectControl(const observer::PlayerParameters& player, const observer::Vector& feedback, double start_m,
                double gap_m2_s, std::uint64_t seed);

  // The display presents the object at this place relative to the goal; about every 15 ms.
  void see(double presented_s, double object_m);
  // The body senses the place of the hand; about every 10 ms.
  void sense_hand(double at_s, double hand_m);
  // The skin feels a force that a coupling of this stiffness (force for each metre of gap, N/m) makes.
  void feel(double at_s, double force_N, double stiffness_N_m);
  // Uses the percepts that have arrived; returns the command, N, for the next control step.
  double command(double now_s);

 private:
  observer::PlayerParameters player_;
  observer::Vector feedback_;
  observer::NoiseStream noise_;
  observer::PerceptChannel eyes_, body_, skin_;
  observer::DelayedKalman estimate_;
  double bias_m_;
};

}  // namespace tactus::experiments
