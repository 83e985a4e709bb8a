// The controller, the reach and the hand.
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "scripts/simulated_player/observer/hand.h"
#include "scripts/simulated_player/observer/lqg.h"
#include "scripts/simulated_player/observer/noise_stream.h"
#include "scripts/simulated_player/observer/reach.h"
#include "scripts/simulated_player/observer/responses.h"

namespace tactus::observer {

TEST_CASE("Optimal reaches with the constants of Todorov 2005 have the scatter of an independent program") {
  // 20,000 runs of a program in another language, 10 cm. The scatter of 4,000 runs has a standard error of 1.1 %,
  // the mean one of 0.1 mm; the tolerances are three of both.
  const double rows[][5]{{0.5, 0.5, -0.80, 5.42, 0.381},
                         {0.3, 0.5, -9.8, 6.78, 0.613},
                         {0.8, 0.5, -0.20, 3.96, 0.199},
                         {0.5, 0.25, 0, 4.36, 0},
                         {0.5, 0.75, 0, 6.42, 0}};
  for (const auto& row : rows) {
    const ReachResult r = reach_2005(row[1], 0.1, row[0], 4000, 1);
    INFO("duration " << row[0] << " s, control noise " << row[1]);
    CHECK(1e3 * r.sd_m == Approx(row[3]).epsilon(0.04));
    if (row[4] == 0) continue;
    CHECK(1e3 * r.bias_m == Approx(row[2]).margin(0.35));
    CHECK(r.peak_m_s == Approx(row[4]).epsilon(0.01));
  }
}

TEST_CASE("Without noise in the command the feedback is that of the linear-quadratic regulator") {
  // One state, one step: u = -b a q / (r + b^2 q) x.
  LqgProblem p;
  p.a = Matrix::Constant(1, 1, 0.9);
  p.b = Vector::Constant(1, 2);
  p.h = Matrix::Identity(1, 1);
  p.process_noise = Matrix::Zero(1, 1);
  p.sensory_noise = Matrix::Identity(1, 1);
  p.running_cost = Matrix::Zero(1, 1);
  p.final_cost = Matrix::Constant(1, 1, 3);
  p.effort = 0.5;
  const double deterministic = 2 * 0.9 * 3 / (0.5 + 4 * 3);
  CHECK(solve_lqg(p, Vector::Ones(1), Matrix::Zero(1, 1)).feedback[0][0] == Approx(deterministic));
  // Noise that grows with the command makes the controller careful: (1 + c^2) b^2 q.
  p.control_share = 0.5;
  CHECK(solve_lqg(p, Vector::Ones(1), Matrix::Zero(1, 1)).feedback[0][0] ==
        Approx(2 * 0.9 * 3 / (0.5 + 1.25 * 4 * 3)));
}

TEST_CASE("The feedback of an endless movement is the fixed point of its equation, for every number of states") {
  NoiseStream noise(3, 1);
  for (int n = 1; n <= kMaxStates; ++n) {
    LqgProblem p;
    p.a = Matrix::NullaryExpr(n, n, [&] { return noise.normal(0.3 / std::sqrt(n)); });
    p.b = Vector::NullaryExpr(n, [&] { return noise.normal(); });
    p.running_cost = p.final_cost = Matrix::Identity(n, n);
    p.control_share = 0.4;
    p.effort = 0.7;
    const Vector feedback = steady_feedback(p);
    Matrix cost = p.running_cost;  // of the closed loop: S = Q + A' S (A - B L)
    for (int i = 0; i < 2000; ++i) {
      const Matrix next = p.running_cost + p.a.transpose() * cost * (p.a - p.b * feedback.transpose());
      cost = 0.5 * (next + next.transpose());
    }
    const Vector again = p.a.transpose() * cost * p.b / (p.effort + 1.16 * p.b.dot(cost * p.b));  // 1 + 0.4^2
    INFO(n << " states");
    CHECK((feedback - again).norm() <= 1e-7 * feedback.norm());
  }
}

TEST_CASE("A problem without states, or with costs of another size, is refused") {
  CHECK_THROWS_AS(steady_feedback(LqgProblem{}), std::invalid_argument);
  LqgProblem p;
  p.a = Matrix::Identity(2, 2);
  p.b = Vector::Ones(2);
  p.running_cost = p.final_cost = Matrix::Zero(2, 3);
  CHECK_THROWS_AS(steady_feedback(p), std::invalid_argument);
}

TEST_CASE("The decay rate of a known system is found") {
  LqgProblem p;
  p.a = Matrix::Zero(2, 2);
  p.a.diagonal() << std::exp(-3 * 0.005), std::exp(-20 * 0.005);
  p.a(0, 1) = 0.3;
  p.b = Vector::Zero(2);
  CHECK(decay_rate(p, Vector::Zero(2), 0.005) == Approx(3).epsilon(1e-3));
}

TEST_CASE("An aimed movement decays at the chosen rate and does not overshoot") {
  const PlayerParameters player;
  for (double rate : {1.5, 2.5, 3.4}) {
    const Vector feedback = approach_feedback(player, rate, 0.005);
    const HandPlant plant = hand_plant(player.mass_kg, player.muscle_s, 0.005);
    Vector x = Vector::Zero(kHandStates);
    x[kPlace] = -0.2;
    double at_one = 0, at_two = 0;
    for (int i = 0; i < 600; ++i) {
      if (i == 200) at_one = x[kPlace];
      if (i == 400) at_two = x[kPlace];
      x = (plant.a * x - plant.b * feedback.dot(x)).eval();
      REQUIRE(x[kPlace] < 1e-4);
    }
    CHECK(std::log(at_one / at_two) == Approx(rate).epsilon(0.05));  // over one second
  }
}

TEST_CASE("The noise of a command does not depend on the step of the simulation") {
  // Variance of the speed after 0.4 s of a constant command; 600 runs give it to 6 %, so the ratio to 8 %.
  const auto variance = [](double dt_s) {
    PlayerParameters player;
    double sum = 0, square = 0;
    constexpr int kRuns = 600;
    for (std::uint64_t run = 0; run < kRuns; ++run) {
      NoiseStream noise(run, 9);
      Hand hand(player, dt_s, 0);
      for (int i = 0; i < std::lround(0.4 / dt_s); ++i) hand.step(2, 0, noise);
      sum += hand.state()[kSpeed], square += hand.state()[kSpeed] * hand.state()[kSpeed];
    }
    return square / kRuns - sum * sum / kRuns / kRuns;
  };
  CHECK(variance(0.002) / variance(0.01) == Approx(1).margin(0.25));
}

TEST_CASE("No correction precedes the latency of its sense") {
  for (double latency : {0.06, 0.08}) {
    PlayerParameters player;
    player.touch_latency_s = latency;
    CHECK(first_response_s(player, Disturbance::kPush) > latency);
    CHECK(first_response_s(player, Disturbance::kPush) < latency + 0.03);
  }
  PlayerParameters slow;
  slow.visual_latency_s = 0.15;
  CHECK(first_response_s(slow, Disturbance::kJump) - first_response_s({}, Disturbance::kJump) ==
        Approx(0.03).margin(0.006));
}

}  // namespace tactus::observer
