// A reach of fixed duration by optimal feedback, with the cost of Todorov 2005: place 1, speed 0.2, force 0.02 at
// the end, and the effort 1e-5 over the number of steps. Pure.
#pragma once

#include <cstdint>

#include "scripts/simulated_player/observer/lqg.h"
#include "scripts/simulated_player/observer/parameters.h"

namespace tactus::observer {

// The problem of Todorov 2005 for a hand of this plant; the state is relative to the target. control_share: noise
// for each step.
LqgProblem reach_problem(double mass_kg, double muscle_s, double control_share, double duration_s, double dt_s);

struct ReachResult {
  double bias_m = 0;  // mean end minus target; negative: short of it
  double sd_m = 0;
  double peak_m_s = 0;  // of the mean speed
};

// `runs` reaches over this distance. The hand sees itself beside the target and senses its own place, each with
// the player's latency and noise (delayed_kalman.h).
ReachResult reach(const PlayerParameters& player, double distance_m, double duration_s, int runs,
                  std::uint64_t seed);

// The same with the constants of Todorov 2005 in place of a player: 1 kg, 40 ms, sensory noise of half of 0.02 m,
// 0.2 m/s and 1 N without delay, and this control noise (0.5 there), dt = 10 ms. It validates the controller.
ReachResult reach_2005(double control_share, double distance_m, double duration_s, int runs, std::uint64_t seed);

}  // namespace tactus::observer
