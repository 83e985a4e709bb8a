// The plant of an aimed movement along one axis: a mass that a muscle of two poles drives, as in Todorov 2005.
// States: place (m) and speed (m/s) relative to the target, force (N), excitation (N). The command is in N. Pure.
#pragma once

#include "scripts/simulated_player/observer/lqg.h"
#include "scripts/simulated_player/observer/noise_stream.h"
#include "scripts/simulated_player/observer/parameters.h"

namespace tactus::observer {

constexpr int kPlace = 0, kSpeed = 1, kForce = 2, kExcitation = 3, kHandStates = 4;

struct HandPlant {
  double dt_s = 0.01;
  Matrix a;
  Vector b;
};
HandPlant hand_plant(double mass_kg, double muscle_s, double dt_s);

// A hand that moves. Its command has noise: a share of the command and a constant part; both are given as standard
// deviations of the mean over 10 ms and scale with the square root of the step, so that the noise does not depend
// on dt_s.
class Hand {
 public:
  Hand(const PlayerParameters& player, double dt_s, double start_m);

  // One step with this command and an external force, N.
  void step(double command_N, double external_N, NoiseStream& noise);
  // Moves the hand, or the origin of its coordinate, by this distance.
  void shift(double distance_m) { state_[kPlace] += distance_m; }
  const Vector& state() const { return state_; }
  const HandPlant& plant() const { return plant_; }
  // Noise of one step: standard deviation as a share of the command, and its constant part.
  double share() const { return share_; }
  double constant_N() const { return constant_N_; }

 private:
  HandPlant plant_;
  double share_, constant_N_, mass_kg_;
  Vector state_;
};

// The feedback of a movement that approaches its target at this rate, 1/s, without overshoot: minimises x^2 + w
// v^2 + effort u^2 over time, with the weight w of the speed that gives the rate. The effort is a design choice.
// When the rate is out of reach, the fastest movement without overshoot.
Vector approach_feedback(const PlayerParameters& player, double rate_1_s, double dt_s);

}  // namespace tactus::observer
