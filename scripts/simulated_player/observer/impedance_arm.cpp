#include "scripts/simulated_player/observer/impedance_arm.h"

#include <cmath>

namespace tactus::observer {
namespace {

constexpr std::uint64_t kArmStream = 21;

Eigen::Vector3d finite_or_zero(const Eigen::Vector3d& v) { return v.allFinite() ? v : Eigen::Vector3d::Zero(); }

}  // namespace

ImpedanceArm::ImpedanceArm(const PlayerParameters& player, const Eigen::Vector3d& start_m, std::uint64_t seed)
    : player_(player), noise_(seed, kArmStream), reference_m_(start_m) {}

double ImpedanceArm::damping_N_s_m() const {
  return 2 * player_.damping_ratio * std::sqrt(player_.stiffness_N_m * player_.mass_kg);
}

void ImpedanceArm::step(const Eigen::Vector3d& command_N, const Eigen::Vector3d& force_N, double dt_s) {
  if (!(dt_s > 0)) return;
  const Eigen::Vector3d command = finite_or_zero(command_N), force = finite_or_zero(force_N);
  const double scale = std::sqrt(0.01 / dt_s);  // noise is given as the mean over 10 ms
  // Semi-implicit steps: stable for the published ranges of mass, stiffness and time constant.
  for (int axis = 0; axis < 3; ++axis) {
    const double u = command[axis] * (1 + noise_.normal(scale * player_.motor_noise_share)) +
                     noise_.normal(scale * player_.motor_noise_N);
    excitation_N_[axis] += dt_s / player_.muscle_s * (u - excitation_N_[axis]);
  }
  muscle_N_ += dt_s / player_.muscle_s * (excitation_N_ - muscle_N_);
  reference_m_s_ += dt_s / player_.mass_kg * muscle_N_;
  reference_m_ += dt_s * reference_m_s_;
  load_N_ += dt_s / player_.muscle_s * (force.norm() - load_N_);
  const Eigen::Vector3d pull = force - stiffness_N_m(load_N_) * offset_m_ - damping_N_s_m() * offset_m_s_;
  offset_m_s_ += dt_s / player_.mass_kg * pull;
  offset_m_ += dt_s * offset_m_s_;
}

}  // namespace tactus::observer
