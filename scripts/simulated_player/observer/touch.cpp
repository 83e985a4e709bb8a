#include "scripts/simulated_player/observer/touch.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "scripts/simulated_player/observer/vision.h"

namespace tactus::observer {
namespace {

constexpr double kSizeShare = 1.0 / 3;

}  // namespace

std::optional<Eigen::Vector3d> felt_force_N(const PlayerParameters& player, const Eigen::Vector3d& force_N,
                                            NoiseStream& noise) {
  const double size = force_N.norm();
  // All numbers are drawn first, so that a force below the floor uses as many as one above.
  const double magnitude = size * (1 + noise.normal(weber_sd(player.force_weber)));
  const double turn = noise.normal(player.force_direction_sd_deg * std::numbers::pi / 180);
  const double about = 2 * std::numbers::pi * noise.uniform();
  if (!(size >= player.force_floor_N)) return std::nullopt;
  const Eigen::Vector3d direction = force_N / size, side = direction.unitOrthogonal();
  const Eigen::Vector3d axis = Eigen::AngleAxisd(about, direction) * side;
  return magnitude * (Eigen::AngleAxisd(turn, axis) * direction);
}

double felt_stiffness(const PlayerParameters& player, double stiffness, NoiseStream& noise) {
  return stiffness * (1 + noise.normal(weber_sd(player.stiffness_weber)));
}

double felt_heat_flow(const PlayerParameters& player, double heat_flow, NoiseStream& noise) {
  return heat_flow * (1 + noise.normal(weber_sd(player.thermal_weber)));
}

double felt_size_sd_m(const PlayerParameters& player) { return kSizeShare * player.proprioceptive_sd_m; }

double vibration_threshold_dB(double frequency_Hz) {
  constexpr double kB = 1 - 250.0 / 550;
  const double ratio = std::log10(frequency_Hz / 550 + kB) / std::log10(kB);
  return 62 * ratio * ratio - 77;
}

}  // namespace tactus::observer
