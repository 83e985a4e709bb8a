#include "scripts/simulated_player/observer/reach.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <vector>

#include "scripts/simulated_player/observer/delayed_kalman.h"
#include "scripts/simulated_player/observer/hand.h"
#include "scripts/simulated_player/observer/vision.h"

namespace tactus::observer {
namespace {

constexpr double kReachStep_s = 0.01, kReachLook_s = 0.1, kReachViewing_m = 0.6;
constexpr std::uint64_t kReachStream = 41;

// Mean and standard deviation of the ends, and the peak of the mean speed.
class ReachStatistics {
 public:
  explicit ReachStatistics(int steps) : speeds_(static_cast<std::size_t>(steps), 0.0) {}
  void add_speed(int step, double speed) { speeds_[static_cast<std::size_t>(step)] += speed; }
  void add_end(double place) { ends_.push_back(place); }
  ReachResult result() const {
    const double n = static_cast<double>(ends_.size());
    double mean = 0, square = 0;
    for (double e : ends_) mean += e / n;
    for (double e : ends_) square += (e - mean) * (e - mean) / (n - 1);
    return {mean, std::sqrt(square), *std::max_element(speeds_.begin(), speeds_.end()) / n};
  }

 private:
  std::vector<double> ends_, speeds_;
};

}  // namespace

LqgProblem reach_problem(double mass_kg, double muscle_s, double control_share, double duration_s, double dt_s) {
  const HandPlant plant = hand_plant(mass_kg, muscle_s, dt_s);
  LqgProblem p;
  p.a = plant.a;
  p.b = plant.b;
  p.steps = static_cast<int>(std::lround(duration_s / dt_s));
  p.control_share = control_share;
  p.h = Matrix::Zero(3, kHandStates);
  for (int i = 0; i < 3; ++i) p.h(i, i) = 1;
  const double sd[]{0.5 * 0.02, 0.5 * 0.2, 0.5 * 1.0};
  p.sensory_noise = Matrix::Zero(3, 3);
  for (int i = 0; i < 3; ++i) p.sensory_noise(i, i) = sd[i] * sd[i];
  p.process_noise = p.running_cost = p.final_cost = Matrix::Zero(kHandStates, kHandStates);
  p.final_cost(kPlace, kPlace) = 1;
  p.final_cost(kSpeed, kSpeed) = 0.2 * 0.2;
  p.final_cost(kForce, kForce) = 0.02 * 0.02;
  p.effort = 1e-5 / p.steps;
  return p;
}

ReachResult reach_2005(double control_share, double distance_m, double duration_s, int runs, std::uint64_t seed) {
  const LqgProblem p = reach_problem(1, 0.04, control_share, duration_s, kReachStep_s);
  Vector start = Vector::Zero(kHandStates);
  start[kPlace] = -distance_m;
  const LqgSolution solution = solve_lqg(p, start, Matrix::Zero(kHandStates, kHandStates));
  ReachStatistics statistics(p.steps);
  for (int run = 0; run < runs; ++run) {
    NoiseStream noise(sync::mixed(seed, kReachStream), static_cast<std::uint64_t>(run));
    Vector x = start, estimate = start;
    for (int t = 0; t < p.steps; ++t) {
      const auto i = static_cast<std::size_t>(t);
      const double u = -solution.feedback[i].dot(estimate);
      Vector y = p.h * x;
      for (int k = 0; k < 3; ++k) y[k] += noise.normal(std::sqrt(p.sensory_noise(k, k)));
      estimate = (p.a * estimate + p.b * u + solution.gain[i] * (y - p.h * estimate)).eval();
      x = (p.a * x + p.b * (u * (1 + noise.normal(control_share)))).eval();
      statistics.add_speed(t, x[kSpeed]);
    }
    statistics.add_end(x[kPlace]);
  }
  return statistics.result();
}

ReachResult reach(const PlayerParameters& player, double distance_m, double duration_s, int runs,
                  std::uint64_t seed) {
  const Hand still(player, kReachStep_s, -distance_m);
  const LqgProblem p = reach_problem(player.mass_kg, player.muscle_s, still.share(), duration_s, kReachStep_s);
  const Vector start = still.state();
  const LqgSolution solution = solve_lqg(p, start, Matrix::Zero(kHandStates, kHandStates));
  HandModel model{.dt_s = kReachStep_s,
                  .a = p.a,
                  .b = p.b,
                  .noise = Matrix::Identity(kHandStates, kHandStates) * 1e-14,
                  .control_share = still.share(),
                  .control_sd = still.constant_N(),
                  .speed_noise_m2_s = player.process_noise_m2_s};
  Vector place = Vector::Zero(kHandStates);
  place[kPlace] = 1;
  const double per_look = std::sqrt(kReachLook_s / kReachStep_s), felt_sd = per_look * player.proprioceptive_sd_m;
  const int seen_late = static_cast<int>(std::lround(player.visual_latency_s / kReachStep_s));
  const int felt_late = static_cast<int>(std::lround(player.touch_latency_s / kReachStep_s));
  ReachStatistics statistics(p.steps);
  for (int run = 0; run < runs; ++run) {
    NoiseStream motor(sync::mixed(seed, kReachStream + 1), static_cast<std::uint64_t>(run));
    NoiseStream senses(sync::mixed(seed, kReachStream + 2), static_cast<std::uint64_t>(run));
    Hand hand(player, kReachStep_s, -distance_m);
    DelayedKalman estimate(model, start, Matrix::Identity(kHandStates, kHandStates) * 1e-10);
    std::vector<double> places{-distance_m};
    for (int t = 0; t < p.steps; ++t) {
      if (t >= seen_late) {
        const double at = places[static_cast<std::size_t>(t - seen_late)];
        const double sd = per_look * seen_gap_sd_m(player, kReachViewing_m, at);
        estimate.measure(player.visual_latency_s, place, at + senses.normal(sd), sd * sd);
      }
      if (t >= felt_late) {
        const double at = places[static_cast<std::size_t>(t - felt_late)];
        estimate.measure(player.touch_latency_s, place, at + senses.normal(felt_sd), felt_sd * felt_sd);
      }
      const double u = -solution.feedback[static_cast<std::size_t>(t)].dot(estimate.mean());
      hand.step(u, 0, motor);
      estimate.predict(u);
      places.push_back(hand.state()[kPlace]);
      statistics.add_speed(t, hand.state()[kSpeed]);
    }
    statistics.add_end(hand.state()[kPlace]);
  }
  return statistics.result();
}

}  // namespace tactus::observer
