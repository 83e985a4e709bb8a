#include "scripts/simulated_player/observer/vision.h"

#include <cmath>
#include <numbers>

namespace tactus::observer {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kHalfArea_px = 4, kHalfContrast = 0.03, kSteepness = 4;
constexpr double kGapShare = 1.0 / 6, kGapE2_deg = 0.7;

double logistic(double log_ratio) { return 1 / (1 + std::exp(-kSteepness * log_ratio)); }

}  // namespace

double seen_sd_m(const PlayerParameters& player, double viewing_m, double off_gaze_m) {
  const double eccentricity_deg = std::atan2(std::abs(off_gaze_m), viewing_m) / kDegree;
  return viewing_m * std::tan(player.visual_sd_deg * kDegree) * (1 + eccentricity_deg / player.visual_e2_deg);
}

double seen_gap_sd_m(const PlayerParameters& player, double viewing_m, double gap_m) {
  const double eccentricity_deg = std::atan2(std::abs(gap_m), viewing_m) / kDegree;
  return viewing_m * std::tan(kGapShare * player.visual_sd_deg * kDegree) * (1 + eccentricity_deg / kGapE2_deg);
}

double seen_depth_sd_m(bool two_eyes) { return two_eyes ? 0.0075 : 0.030; }

double weber_sd(double weber) {
  constexpr double kUpperQuartile = 0.6744897501960817;  // normal quantile of 75 %
  return weber / (kUpperQuartile * std::numbers::sqrt2);
}

double seen_speed_m_s(const PlayerParameters& player, double speed_m_s, NoiseStream& noise) {
  return speed_m_s * (1 + noise.normal(weber_sd(player.visual_speed_weber)));
}

double detection_probability(double visible_px, double contrast) {
  if (!(visible_px > 0) || !(contrast > 0)) return 0;
  return logistic(std::log(visible_px / kHalfArea_px)) * logistic(std::log(contrast / kHalfContrast));
}

}  // namespace tactus::observer
