// Optimal feedback control of a linear system whose command noise grows with the command: Todorov 2005,
// "Stochastic optimal control and estimation methods adapted to the noise characteristics of the sensorimotor
// system", Neural Computation 17:1084. One command. Pure.
#pragma once

#include <vector>

#include "scripts/simulated_player/observer/matrices.h"

namespace tactus::observer {

// x' = A x + B (1 + c e) u + w,  y = H x + v;  cost = sum of x' Q x + effort u^2, and the final cost at the last
// step.
struct LqgProblem {
  Matrix a;
  Vector b;
  Matrix h;
  Matrix process_noise;      // covariance of w for each step
  Matrix sensory_noise;      // covariance of v for each step
  double control_share = 0;  // c
  Matrix running_cost, final_cost;
  double effort = 1;
  int steps = 1;
};

struct LqgSolution {
  std::vector<Vector> feedback;  // u = -feedback . estimate, one for each step
  std::vector<Matrix> gain;      // of the filter: estimate' = A estimate + B u + gain (y - H estimate)
};

// Iterates controller and filter until the feedback changes by less than 1e-9 of its size, at most 200 times
// (equations 4.2 and 5.2 of Todorov 2005, without state-dependent sensory noise). start: the known state;
// start_covariance: its uncertainty. Throws std::invalid_argument when sizes differ.
LqgSolution solve_lqg(const LqgProblem& problem, const Vector& start, const Matrix& start_covariance);

// The feedback of an endless movement: the fixed point of the same equation (Qian, Jiang, Jiang and Mazzoni 2013,
// Neural Computation 25:697, use such a controller for aimed movements). The filter is optimal, so its error does
// not enter.
Vector steady_feedback(const LqgProblem& problem);

// Slowest decay rate of x' = (A - B L) x, 1/s; 0 or less: unstable.
double decay_rate(const LqgProblem& problem, const Vector& feedback, double dt_s);

}  // namespace tactus::observer
