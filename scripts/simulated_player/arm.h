// The arm that holds the device: it follows the player's target with the speed, tremor and compliance of an arm. Pure.
#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace tactus::simulated_player {

// Design, in the range of measured hands that hold a posture (Tsuji, Morasso, Goto and Ito 1995, Biological Cybernetics 72,
// "Human hand impedance characteristics during maintained posture").
struct ArmDef {
  double mass_kg = 1.0;
  double stiffness_N_m = 300;
  double damping_N_s_m = 25;
  // Movement noise grows with the motor command (Harris and Wolpert 1998, Nature 394, "Signal-dependent noise determines
  // motor planning"); the share is a design choice.
  double noise_share = 0.02;
};

class Arm {
 public:
  Arm(const ArmDef& def, const Eigen::Vector3d& start_m, std::uint64_t seed) : def_(def), seed_(seed), position_(start_m), target_(start_m) {}

  // One step of dt_s, at most 2 ms, towards `target_m`, while the device pushes with force_N.
  void step(const Eigen::Vector3d& target_m, const Eigen::Vector3d& force_N, double dt_s);
  const Eigen::Vector3d& position_m() const { return position_; }
  const Eigen::Vector3d& velocity_m_s() const { return velocity_; }

 private:
  ArmDef def_;
  std::uint64_t seed_, steps_ = 0;
  Eigen::Vector3d position_, target_;
  Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero(), tremor_ = Eigen::Vector3d::Zero();
};

}  // namespace tactus::simulated_player
