// The arm in space: muscles drive a reference movement, and the arm's impedance ties the hand to it. Without
// external force the hand is the reference; a push moves it away as a spring, damper and mass do, at once, before
// any nerve reacts. Pure.
#pragma once

#include <Eigen/Core>

#include "scripts/simulated_player/observer/noise_stream.h"
#include "scripts/simulated_player/observer/parameters.h"

namespace tactus::observer {

class ImpedanceArm {
 public:
  ImpedanceArm(const PlayerParameters& player, const Eigen::Vector3d& start_m, std::uint64_t seed);

  // One step of dt_s, at most 2 ms, with a command to the muscles and a force of the device on the hand, N. Values
  // that are not finite count as 0.
  void step(const Eigen::Vector3d& command_N, const Eigen::Vector3d& force_N, double dt_s);
  Eigen::Vector3d position_m() const { return reference_m_ + offset_m_; }
  Eigen::Vector3d velocity_m_s() const { return reference_m_s_ + offset_m_s_; }
  // Displacement of the hand from its reference, m.
  const Eigen::Vector3d& offset_m() const { return offset_m_; }
  // Stiffness at this load: K0 + k1 |F| (structure: Tee, Burdet, Chew and Milner 2004), and the damping for its
  // ratio.
  double stiffness_N_m(double load_N) const { return player_.stiffness_N_m + player_.stiffness_rise_1_m * load_N; }
  double damping_N_s_m() const;

 private:
  PlayerParameters player_;
  NoiseStream noise_;
  Eigen::Vector3d reference_m_, reference_m_s_{0, 0, 0}, muscle_N_{0, 0, 0}, excitation_N_{0, 0, 0};
  Eigen::Vector3d offset_m_{0, 0, 0}, offset_m_s_{0, 0, 0};
  double load_N_ = 0;  // smoothed
};

}  // namespace tactus::observer
