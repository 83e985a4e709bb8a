#include "scripts/simulated_player/observer/hand.h"

#include <cmath>

namespace tactus::observer {
namespace {

// Command for each metre of distance if nothing else cost anything (design: a reach of 0.2 m then peaks after
// about 0.2 s).
constexpr double kVigour_N_m = 80;
constexpr int kBisections = 24;

// True when a movement from rest passes its target.
bool overshoots(const LqgProblem& p, const Vector& feedback) {
  Vector x = Vector::Zero(p.b.size());
  x[kPlace] = 1;
  const Matrix closed = p.a - p.b * feedback.transpose();
  for (int i = 0; i < 1000 && x[kPlace] > 1e-3; ++i) {
    x = (closed * x).eval();
    if (x[kPlace] < 0) return true;
  }
  return false;
}

}  // namespace

HandPlant hand_plant(double mass_kg, double muscle_s, double dt_s) {
  HandPlant plant{dt_s, Matrix::Identity(kHandStates, kHandStates), Vector::Zero(kHandStates)};
  plant.a(kPlace, kSpeed) = dt_s;
  plant.a(kSpeed, kForce) = dt_s / mass_kg;
  plant.a(kForce, kForce) = plant.a(kExcitation, kExcitation) = 1 - dt_s / muscle_s;
  plant.a(kForce, kExcitation) = plant.b[kExcitation] = dt_s / muscle_s;
  return plant;
}

Hand::Hand(const PlayerParameters& player, double dt_s, double start_m)
    : plant_(hand_plant(player.mass_kg, player.muscle_s, dt_s)),
      share_(player.motor_noise_share * std::sqrt(0.01 / dt_s)),
      constant_N_(player.motor_noise_N * std::sqrt(0.01 / dt_s)),
      mass_kg_(player.mass_kg),
      state_(Vector::Zero(kHandStates)) {
  state_[kPlace] = start_m;
}

void Hand::step(double command_N, double external_N, NoiseStream& noise) {
  const double u = command_N * (1 + noise.normal(share_)) + noise.normal(constant_N_);
  state_ = (plant_.a * state_ + plant_.b * u).eval();
  state_[kSpeed] += plant_.dt_s * external_N / mass_kg_;
}

Vector approach_feedback(const PlayerParameters& player, double rate_1_s, double dt_s) {
  const HandPlant plant = hand_plant(player.mass_kg, player.muscle_s, dt_s);
  LqgProblem p;
  p.a = plant.a;
  p.b = plant.b;
  p.control_share = player.motor_noise_share * std::sqrt(0.01 / dt_s);
  p.running_cost = p.final_cost = Matrix::Zero(kHandStates, kHandStates);
  p.running_cost(kPlace, kPlace) = 1;
  p.effort = 1 / (kVigour_N_m * kVigour_N_m);
  Vector feedback = Vector::Zero(kHandStates);
  // More weight of the speed slows the movement: bisection in its logarithm.
  double low = std::log(1e-3 / (rate_1_s * rate_1_s)), high = std::log(1e2 / (rate_1_s * rate_1_s));
  for (int i = 0; i < kBisections; ++i) {
    p.running_cost(kSpeed, kSpeed) = std::exp((low + high) / 2);
    feedback = steady_feedback(p);
    const bool fast = decay_rate(p, feedback, dt_s) > rate_1_s || overshoots(p, feedback);
    (fast ? low : high) = (low + high) / 2;
  }
  return feedback;
}

}  // namespace tactus::observer
