#include "scripts/experiments/guided_arm.h"

#include <cmath>

namespace tactus::experiments {

void GuidedArm::step(double intended_m, double intended_m_s, double force_N, double dt_s) {
  load_N_ += dt_s / player_.muscle_s * (std::abs(force_N) - load_N_);
  const double stiffness = player_.stiffness_N_m + player_.stiffness_rise_1_m * load_N_;
  const double damping = 2 * player_.damping_ratio * std::sqrt(player_.stiffness_N_m * player_.mass_kg);
  offset_m_s_ += dt_s / player_.mass_kg * (force_N - stiffness * offset_m_ - damping * offset_m_s_);
  offset_m_ += dt_s * offset_m_s_;
  const double speed = intended_m_s + offset_m_s_;
  acceleration_m_s2_ = (speed - speed_m_s_) / dt_s;
  speed_m_s_ = speed;
  place_m_ = intended_m + offset_m_;
}

}  // namespace tactus::experiments
