// A person moves a body along a moving target through a connection that is late, sends only changes, or loses
// packets: the task of Chaudhari et al. 2011. The velocity of the hand drives the body, and the force of the
// coupling returns to the hand. The picture of the body is not delayed.
#include <algorithm>
#include <cmath>
#include <deque>
#include <numbers>

#include "scripts/experiments/object_control.h"
#include "scripts/experiments/paradigms.h"
#include "scripts/simulated_player/observer/impedance_arm.h"

namespace tactus::experiments {
namespace {

constexpr double kPursuitStep_s = 0.001, kSettle_s = 1;
constexpr double kTargetGap_m2_s = 2.5e-3;  // design: the target is expected to move by 5 cm within a second
constexpr double kBodyDamping_N_s_m = 1;    // design: slight friction of the body

// One direction of the connection: a Weber deadband that holds the last sent value, losses, and a constant delay.
class OneWay {
 public:
  OneWay(int steps, double share, double loss, std::uint64_t seed)
      : waiting_(static_cast<std::size_t>(steps), 0.0), share_(share), loss_(loss), noise_(seed, 1) {}

  double pass(double value) {
    const bool lost = noise_.uniform() < loss_;
    if (std::abs(value - sent_) > share_ * std::abs(sent_)) {
      sent_ = value;
      if (!lost) arrived_ = value;
    }
    waiting_.push_back(arrived_);
    const double now = waiting_.front();
    waiting_.pop_front();
    return now;
  }

 private:
  std::deque<double> waiting_;
  double share_, loss_, sent_ = 0, arrived_ = 0;
  observer::NoiseStream noise_;
};

// A sum of three sines, m: unpredictable for a player that expects a random walk.
double target_m(double t_s) {
  const double w = 2 * std::numbers::pi * t_s;
  return 0.04 * std::sin(0.11 * w) + 0.025 * std::sin(0.23 * w) + 0.015 * std::sin(0.37 * w);
}

}  // namespace

// Settings: delay_ms of each direction, deadband_percent of velocity and force, loss_percent; mass_kg of the body,
// stiffness_N_m and damping_N_s_m of its coupling; duration_s. Answers error_mm, the mean distance of the body
// from the target.
Outcome pursuit(Participant& p, const TrialSettings& s, std::uint64_t number) {
  const int steps = static_cast<int>(std::lround(s.number_or("delay_ms", 0, 0, 1000)));
  const double share = s.number_or("deadband_percent", 0, 0, 100) / 100,
               loss = s.number_or("loss_percent", 0, 0, 100) / 100,
               mass_kg = s.number_or("mass_kg", 0.75, 0.01, 10),
               stiffness = s.number_or("stiffness_N_m", 300, 1, 5000),
               damping = s.number_or("damping_N_s_m", 10, 0, 500),
               duration_s = s.number_or("duration_s", 10, 2, 120);
  const std::uint64_t seed = p.trial_seed("pursuit", number);
  const auto& feedback = p.prepared<observer::Vector>("pursuit", [&] { return paced_feedback(p.player()); });
  ObjectControl control(p.player(), feedback, 0, kTargetGap_m2_s, seed);
  observer::ImpedanceArm arm(p.player(), Eigen::Vector3d::Zero(), seed);
  OneWay forth(steps, share, loss, sync::mixed(seed, 5)), back(steps, share, loss, sync::mixed(seed, 6));
  double body_m = 0, body_m_s = 0, reference_m = 0, command_N = 0, sum_m = 0;
  int counted = 0;
  for (int i = 0; i * kPursuitStep_s < duration_s; ++i) {
    const double now_s = i * kPursuitStep_s, error_m = body_m - target_m(now_s);
    if (now_s >= kSettle_s) sum_m += std::min(std::abs(error_m), 1.0), ++counted;
    if (i % 15 == 0) control.see(now_s, std::clamp(error_m, -1.0, 1.0));
    if (i % 10 == 0) control.sense_hand(now_s, arm.position_m().x());
    if (i % 5 == 0) command_N = control.command(now_s);
    const double wanted_m_s = forth.pass(arm.velocity_m_s().x());
    const double force_N = stiffness * (reference_m - body_m) + damping * (wanted_m_s - body_m_s);
    const double felt_N = std::clamp(-back.pass(force_N), -50.0, 50.0);  // the device is limited
    arm.step(Eigen::Vector3d(command_N, 0, 0), Eigen::Vector3d(felt_N, 0, 0), kPursuitStep_s);
    reference_m += wanted_m_s * kPursuitStep_s;
    body_m_s += kPursuitStep_s / mass_kg * (force_N - kBodyDamping_N_s_m * body_m_s);
    body_m += body_m_s * kPursuitStep_s;
  }
  return {{"error_mm", 1e3 * sum_m / std::max(counted, 1)}};
}

}  // namespace tactus::experiments
