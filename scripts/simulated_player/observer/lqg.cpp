#include "scripts/simulated_player/observer/lqg.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace tactus::observer {
namespace {

// The power 2^24. The size of a power also has a constant factor c, whose share of the rate is log(c) / (2^24 dt).
constexpr int kSquarings = 24;

// One backward step: the feedback, and the new cost matrices of state (sx) and estimation error (se). Todorov
// 2005, eq. 4.2.
Vector backward(const LqgProblem& p, Matrix& sx, Matrix& se, const Matrix& gain) {
  const double c2 = p.control_share * p.control_share;
  const double weight = p.effort + p.b.dot(sx * p.b) + c2 * p.b.dot((sx + se) * p.b);
  const Vector feedback = (p.b.transpose() * sx * p.a).transpose() / weight;
  const Matrix closed = p.a - p.b * feedback.transpose();
  const Matrix next_se = p.a.transpose() * sx * p.b * feedback.transpose();
  const Matrix filter = p.a - gain * p.h;
  se = (next_se + filter.transpose() * se * filter).eval();
  sx = (p.running_cost + p.a.transpose() * sx * closed).eval();
  sx = (0.5 * (sx + sx.transpose())).eval();
  return feedback;
}

// The fixed point of the same step for N states, without an error of estimation. A fixed size takes an eighth of the time.
template <int N>
Vector steady(const LqgProblem& p) {
  using Square = Eigen::Matrix<double, N, N>;
  using Column = Eigen::Matrix<double, N, 1>;
  const Square a = p.a, running = p.running_cost;
  const Column b = p.b;
  const double share = 1 + p.control_share * p.control_share;
  Square sx = running;
  Column feedback = Column::Zero();
  for (int i = 0; i < 20000; ++i) {
    const Column sb = sx * b;
    const Column next = a.transpose() * sb / (p.effort + share * b.dot(sb));
    const bool converged = (next - feedback).norm() <= 1e-9 * next.norm();
    feedback = next;
    const Square closed = a - b * feedback.transpose();
    const Square cost = running + a.transpose() * (sx * closed);
    sx = 0.5 * (cost + cost.transpose());
    if (converged && i > 20) break;
  }
  return feedback;
}

// The filters for given feedbacks. Todorov 2005, eq. 5.2.
std::vector<Matrix> forward(const LqgProblem& p, const std::vector<Vector>& feedback, const Vector& start,
                            const Matrix& start_covariance) {
  std::vector<Matrix> gains;
  const auto n = start.size();
  Matrix error = start_covariance, estimate = start * start.transpose(), mixed = Matrix::Zero(n, n);
  for (const Vector& l : feedback) {
    const Matrix s = p.h * error * p.h.transpose() + p.sensory_noise;
    const Matrix gain = s.ldlt().solve(p.h * error * p.a.transpose()).transpose();
    const Matrix closed = p.a - p.b * l.transpose(), filter = p.a - gain * p.h;
    const double command = l.dot((estimate)*l);  // mean square of the command
    const Matrix correction = gain * p.h * error * p.a.transpose();
    const Matrix cross = closed * mixed * p.h.transpose() * gain.transpose();
    const Matrix next = p.process_noise + filter * error * p.a.transpose() +
                        p.control_share * p.control_share * command * p.b * p.b.transpose();
    estimate = (correction + closed * estimate * closed.transpose() + cross + cross.transpose()).eval();
    mixed = (closed * mixed * filter.transpose()).eval();
    error = 0.5 * (next + next.transpose());
    gains.push_back(gain);
  }
  return gains;
}

void require_sizes(const LqgProblem& p) {
  const auto n = p.b.size();
  if (n < 1 || p.a.rows() != n || p.a.cols() != n || p.running_cost.rows() != n || p.running_cost.cols() != n ||
      p.final_cost.rows() != n || p.final_cost.cols() != n || p.steps < 1)
    throw std::invalid_argument(
        "lqg: sizes of A, B and the costs differ, or there is no step; give matrices of one state");
}

}  // namespace

LqgSolution solve_lqg(const LqgProblem& p, const Vector& start, const Matrix& start_covariance) {
  require_sizes(p);
  const auto n = p.b.size();
  LqgSolution solution;
  solution.feedback.assign(static_cast<std::size_t>(p.steps), Vector::Zero(n));
  solution.gain.assign(static_cast<std::size_t>(p.steps), Matrix::Zero(n, p.h.rows()));
  for (int round = 0; round < 200; ++round) {
    Matrix sx = p.final_cost, se = Matrix::Zero(n, n);
    double change = 0, size = 0;
    for (int t = p.steps - 1; t >= 0; --t) {
      Vector& feedback = solution.feedback[static_cast<std::size_t>(t)];
      const Vector next = backward(p, sx, se, solution.gain[static_cast<std::size_t>(t)]);
      change = std::max(change, (next - feedback).norm());
      size = std::max(size, next.norm());
      feedback = next;
    }
    solution.gain = forward(p, solution.feedback, start, start_covariance);
    if (change <= 1e-9 * size) break;
  }
  return solution;
}

Vector steady_feedback(const LqgProblem& p) {
  require_sizes(p);
  switch (p.b.size()) {
    case 1: return steady<1>(p);
    case 2: return steady<2>(p);
    case 3: return steady<3>(p);
    case 4: return steady<4>(p);
    case 5: return steady<5>(p);
    case 6: return steady<6>(p);
    case 7: return steady<7>(p);
    default: return steady<kMaxStates>(p);
  }
}

double decay_rate(const LqgProblem& p, const Vector& feedback, double dt_s) {
  // The spectral radius from the size of a high power, |A^n|^(1/n), by squaring.
  Matrix power = p.a - p.b * feedback.transpose();
  double log_size = 0, exponent = 1;
  for (int i = 0; i < kSquarings; ++i) {
    const double size = power.norm();
    power = (power / size * (power / size)).eval();
    log_size = 2 * (log_size + std::log(size));
    exponent *= 2;
  }
  return -(log_size + std::log(power.norm())) / exponent / dt_s;
}

}  // namespace tactus::observer
