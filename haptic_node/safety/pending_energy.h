// Estimates the energy that a body has received since the last touch model reported it. The pushes that are not
// yet reported are replayed on a mass that moves as last reported.
//
//   m du/dt = g - h,   W = integral of g u
//
//   u  speed of the body along the push, at first as reported
//   g  push along the normal of its surface, as rendered
//   h  force of other bodies that recently held it against the push; below zero: pulled it away
//
// The estimate errs on the high side. The holding force stops the body and does not drive it back, and the body
// moves towards the hand by its own motion only. After kHoldingTime_s the holding force is assumed to be zero (a
// pulling force remains), and a body that came towards the hand may have swung back. Along the surface it keeps
// the reported velocity. Pure.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>

namespace tactus::haptic {

class PendingEnergyEstimator {
 public:
  // State of a body as the touch model of time sim_ns reports it. impulse_N_s: the part of the impulse passed to
  // add_push() that had reached the body by then.
  struct BodyReport {
    std::int64_t sim_ns = -1;
    double mass_kg = 0;
    Eigen::Vector3d normal = Eigen::Vector3d::UnitZ(), velocity = Eigen::Vector3d::Zero();
    Eigen::Vector3d impulse_N_s = Eigen::Vector3d::Zero();
  };
  // Stores a report. max_force_N: upper bound of the force on the body. Realtime-safe: yes.
  void on_report(const BodyReport& report, double max_force_N);
  // Stores a report without motion.
  void on_report(const Eigen::Vector3d& impulse_N_s);
  // Adds one tick with this force on the body. Realtime-safe: yes.
  void add_push(const Eigen::Vector3d& force_N, double dt);
  // Pending energy, J. The model already includes every force rendered more than window_s ago. Realtime-safe: yes.
  double energy_J(double window_s, double max_force_N);

  // Estimated current velocity, m/s.
  Eigen::Vector3d velocity() const {
    return report_.velocity - (speed_m_s_ + report_.velocity.dot(report_.normal)) * report_.normal;
  }
  // Total rendered impulse.
  const Eigen::Vector3d& total_impulse_N_s() const { return total_impulse_N_s_; }
  // Clears the pending energy and sets the total impulse.
  void reset(const Eigen::Vector3d& impulse_N_s);
  void reset() { reset(report_.impulse_N_s); }

 private:
  // About one millisecond of pushes. For delays longer than the whole array the coupling is almost zero
  // (coupling.h).
  struct Push {
    double impulse_N_s = 0, dt = 0;
  };
  void replay(double window_s, double pending_N_s);
  void advance(double push_N, double dt);
  double swing_back_m_s() const;

  std::array<Push, 128> pushes_{};
  std::size_t newest_ = 0, count_ = 0;
  Eigen::Vector3d total_impulse_N_s_ = Eigen::Vector3d::Zero();
  BodyReport report_;
  double holding_N_ = 0;
  // Since the last report.
  double since_report_s_ = 0, speed_m_s_ = 0, work_J_ = 0;
  bool fresh_ = false;
};

}  // namespace tactus::haptic
