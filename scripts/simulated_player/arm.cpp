#include "scripts/simulated_player/arm.h"

#include <cmath>

#include "sync/random/keyed_random.h"

namespace tactus::simulated_player {
namespace {

// Correlation time of the tremor (design: movements are corrected about five times a second).
constexpr double kTremor_s = 0.2;

}  // namespace

void Arm::step(const Eigen::Vector3d& wanted_m, const Eigen::Vector3d& force_N, double dt_s) {
  const Eigen::Vector3d commanded = (wanted_m - wanted_) / dt_s;
  wanted_ = wanted_m;
  // A first-order process; its standard deviation is a share of the commanded speed.
  const double keep = std::exp(-dt_s / kTremor_s);
  Eigen::Vector3d drawn;
  for (int axis = 0; axis < 3; ++axis)
    drawn[axis] = sync::normal_quantile(sync::uniform(seed_, 3 * steps_ + static_cast<std::uint64_t>(axis)));
  ++steps_;
  tremor_ = keep * tremor_ + std::sqrt(1 - keep * keep) * def_.noise_share * commanded.norm() * drawn;
  const Eigen::Vector3d pull = def_.stiffness_N_m * (wanted_ - position_) + def_.damping_N_s_m * (commanded + tremor_ - velocity_);
  velocity_ += dt_s / def_.mass_kg * (pull + force_N);  // semi-implicit: stable for these values and dt_s
  position_ += dt_s * velocity_;
}

}  // namespace tactus::simulated_player
