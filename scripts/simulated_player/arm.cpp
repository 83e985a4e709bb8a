#include "scripts/simulated_player/arm.h"

#include <cmath>

#include "sync/random/keyed_random.h"

namespace tactus::simulated_player {
namespace {

// Correlation time of the tremor (design: movements are corrected about five times a second).
constexpr double kTremor_s = 0.2;

}  // namespace

void Arm::step(const Eigen::Vector3d& target_m, const Eigen::Vector3d& force_N, double dt_s) {
  const Eigen::Vector3d commanded = (target_m - target_) / dt_s;
  target_ = target_m;
  // A first-order process; its standard deviation is a share of the commanded speed.
  const double decay = std::exp(-dt_s / kTremor_s);
  Eigen::Vector3d noise;
  for (int axis = 0; axis < 3; ++axis)
    noise[axis] = sync::normal_quantile(sync::uniform(seed_, 3 * steps_ + static_cast<std::uint64_t>(axis)));
  ++steps_;
  tremor_ = decay * tremor_ + std::sqrt(1 - decay * decay) * def_.noise_share * commanded.norm() * noise;
  const Eigen::Vector3d pull = def_.stiffness_N_m * (target_ - position_) + def_.damping_N_s_m * (commanded + tremor_ - velocity_);
  velocity_ += dt_s / def_.mass_kg * (pull + force_N);  // semi-implicit: stable for these values and dt_s
  position_ += dt_s * velocity_;
}

}  // namespace tactus::simulated_player
