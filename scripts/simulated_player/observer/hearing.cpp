#include "scripts/simulated_player/observer/hearing.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scripts/simulated_player/observer/cue_combination.h"
#include "scripts/simulated_player/observer/vision.h"

namespace tactus::observer {
namespace {

constexpr double kSideFactor = 2.6, kDistanceScale = 1.32, kDistanceExponent = 0.54, kUnrelated_s = 1;

double wrapped_deg(double angle) { return std::remainder(angle, 360.0); }

}  // namespace

double azimuth_sd_deg(const PlayerParameters& player, double azimuth_deg) {
  const double side = std::abs(std::sin(azimuth_deg * std::numbers::pi / 180));
  return player.azimuth_sd_deg * (1 + (kSideFactor - 1) * side);
}

SourcePlace heard_place(const PlayerParameters& player, const SourcePlace& source, NoiseStream& noise) {
  SourcePlace heard;
  const double sd = azimuth_sd_deg(player, source.azimuth_deg);
  heard.azimuth_deg = source.azimuth_deg + noise.normal(sd);
  heard.elevation_deg = std::clamp(source.elevation_deg + noise.normal(player.elevation_factor * sd), -90.0, 90.0);
  if (noise.uniform() < player.front_back_confusion) heard.azimuth_deg = 180 - heard.azimuth_deg;
  heard.azimuth_deg = wrapped_deg(heard.azimuth_deg);
  const double compressed = kDistanceScale * std::pow(std::max(source.distance_m, 0.0), kDistanceExponent);
  // The Weber fraction holds for the true distance; the compression scales it.
  heard.distance_m =
      std::max(0.0, compressed * (1 + noise.normal(kDistanceExponent * weber_sd(player.distance_weber))));
  return heard;
}

double same_event_probability(const PlayerParameters& player, double difference_s, double sound_sd_s,
                              double other_sd_s) {
  return infer_cause({difference_s / 2, sound_sd_s * sound_sd_s}, {-difference_s / 2, other_sd_s * other_sd_s},
                     kUnrelated_s * kUnrelated_s, player.common_cause)
      .common;
}

}  // namespace tactus::observer
