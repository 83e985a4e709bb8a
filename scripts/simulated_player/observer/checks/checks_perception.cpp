// Checks of perception: 6 to 9.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "scripts/simulated_player/observer/checks/checks.h"
#include "scripts/simulated_player/observer/checks/expected.h"
#include "scripts/simulated_player/observer/checks/psychometric.h"
#include "scripts/simulated_player/observer/cue_combination.h"
#include "scripts/simulated_player/observer/delay_belief.h"
#include "scripts/simulated_player/observer/hearing.h"
#include "scripts/simulated_player/observer/touch.h"
#include "scripts/simulated_player/observer/vision.h"

namespace tactus::observer {
namespace {

constexpr double kNone = std::numeric_limits<double>::infinity();
constexpr double kQuartile = 0.6744897501960817;
enum CheckStream : std::uint64_t {
  kSizeStream = 51,
  kVentriloquismStream,
  kThresholdStream,
  kRecalibrationStream
};

int trials_of(int trials, const CheckEffort& effort) {
  return std::max(50, static_cast<int>(std::lround(trials * effort.share)));
}

using Percept = std::function<double(double stimulus, NoiseStream&)>;

// Two intervals, one with the standard and one with a comparison: which is larger? Comparisons lie within `range`
// of the standard. Answers the point of equality and the standard deviation of the difference.
NormalFit two_intervals(const Percept& of_standard, const Percept& of_comparison, double standard, double range,
                        int trials, NoiseStream& noise) {
  std::vector<Level> levels;
  for (double step : {-1.0, -0.6, -0.3, 0.3, 0.6, 1.0}) {
    Level level{standard + step * range, 0, static_cast<double>(trials)};
    for (int i = 0; i < trials; ++i) level.yes += of_comparison(level.x, noise) > of_standard(standard, noise);
    levels.push_back(level);
  }
  return fit_normal(levels);
}

// A threshold at 75 % as a share of the standard, in a band of published values. The band is wider by three
// standard errors of the measurement (3 % for 8,000 answers at these levels), so that a player at the edge of the
// band is not refused by chance.
CheckResult threshold(const char* quantity, const Percept& percept, double standard, double expected, double low,
                      double high, const char* source, Evidence evidence, int trials, NoiseStream& noise) {
  const NormalFit fit = two_intervals(percept, percept, standard, 2 * expected * standard, trials, noise);
  const double slack = 3 * 0.03 * std::sqrt(8000.0 / (6.0 * trials));
  return {8,
          quantity,
          "1",
          kQuartile * fit.sd / standard,
          low * (1 - slack),
          high * (1 + slack),
          "5-95 % of people",
          source,
          evidence};
}

}  // namespace

std::vector<CheckResult> check_size(const PlayerParameters& player, std::uint64_t seed,
                                    const CheckEffort& effort) {
  // Ernst and Banks 2002: a bar of 55 mm, seen with four levels of noise and felt; conflicts of 0 and 3 mm.
  constexpr double kBar_mm = 55, kConflict_mm = 3;
  constexpr std::array kSeen_mm{1.55, 2.2, 4.7, 8.0};
  const double felt_mm = 1e3 * felt_size_sd_m(player);
  const int trials = trials_of(1200, effort);
  NoiseStream noise(seed, kSizeStream);
  const Percept by_touch = [&](double size, NoiseStream& n) { return size + n.normal(felt_mm); };
  const double touch_sd = two_intervals(by_touch, by_touch, kBar_mm, 2 * felt_mm, trials, noise).sd;
  double worst = 0, last = 2, least_fall = kNone;
  for (double seen_mm : kSeen_mm) {
    const Percept by_sight = [&](double size, NoiseStream& n) { return size + n.normal(seen_mm); };
    const auto both = [&](double conflict) -> Percept {
      return [=](double size, NoiseStream& n) {
        const std::array cues{Cue{size + conflict / 2 + n.normal(seen_mm), seen_mm * seen_mm},
                              Cue{size - conflict / 2 + n.normal(felt_mm), felt_mm * felt_mm}};
        return combine(cues).value;
      };
    };
    const double sight_sd = two_intervals(by_sight, by_sight, kBar_mm, 2 * seen_mm, trials, noise).sd;
    const double range = 2 / std::sqrt(1 / (felt_mm * felt_mm) + 1 / (seen_mm * seen_mm));
    const double both_sd = two_intervals(both(0), both(0), kBar_mm, range, trials, noise).sd;
    const double predicted = 1 / std::sqrt(1 / (touch_sd * touch_sd) + 1 / (sight_sd * sight_sd));
    worst = std::max(worst, std::abs(both_sd / predicted - 1));
    // The standard has the conflict: its sight is larger than its touch, so equality shifts by (w - 1/2) conflict.
    const double weight =
        0.5 + (two_intervals(both(kConflict_mm), both(0), kBar_mm, range + kConflict_mm / 2, trials, noise).mean -
               kBar_mm) /
                  kConflict_mm;
    least_fall = std::min(least_fall, last - weight);
    last = weight;
  }
  const char* source = "Ernst and Banks 2002, Nature 415:429";
  return {{6, "bimodal threshold against the maximum-likelihood prediction", "%", 100 * worst, 0, 15, "equal",
           source, Evidence::kVerified},
          {6, "smallest fall of the visual weight with visual noise", "1", least_fall, 1e-3, kNone, "falls",
           source, Evidence::kVerified}};
}

std::vector<CheckResult> check_ventriloquism(const PlayerParameters& player, std::uint64_t seed,
                                             const CheckEffort& effort) {
  NoiseStream noise(seed, kVentriloquismStream);
  const int trials = trials_of(2000, effort);
  const double va = player.azimuth_sd_deg * player.azimuth_sd_deg,
               vv = player.visual_sd_deg * player.visual_sd_deg;
  double peak_bias = 0, peak_deg = 0, bias = 0;
  for (double disparity = 1; disparity <= 30; disparity += 1) {
    bias = 0;
    for (int i = 0; i < trials; ++i) {
      const double sound = -disparity / 2 + noise.normal(player.azimuth_sd_deg),
                   sight = disparity / 2 + noise.normal(player.visual_sd_deg);
      const double alone = sound / va / (1 / va + 1 / (kPlacesOfCauses_deg * kPlacesOfCauses_deg));
      bias += (infer_cause({sound, va}, {sight, vv}, kPlacesOfCauses_deg * kPlacesOfCauses_deg, player.common_cause).a - alone) /
              trials;
    }
    if (bias > peak_bias) peak_bias = bias, peak_deg = disparity;
  }
  const char* source = "Koerding, Beierholm, Ma, Quartz, Tenenbaum and Shams 2007, PLoS ONE 2:e943";
  const double wider = expected_peak_deg(player) / expected_peak_deg({});
  return {{7, "disparity of the largest shift of a sound", "degree", peak_deg, 5 * wider, 15 * wider,
           "rises, then falls", source, Evidence::kVerified},
          {7, "shift at 30 degrees against the largest", "1", bias / peak_bias, 0, 0.8, "falls", source,
           Evidence::kVerified}};
}

std::vector<CheckResult> check_thresholds(const PlayerParameters& player, std::uint64_t seed,
                                          const CheckEffort& effort) {
  NoiseStream noise(seed, kThresholdStream);
  const int n = trials_of(2000, effort);
  const Percept force = [&](double f, NoiseStream& r) {
    const auto felt = felt_force_N(player, Eigen::Vector3d(f, 0, 0), r);
    return felt ? felt->norm() : 0;
  };
  const Percept stiffness = [&](double k, NoiseStream& r) { return felt_stiffness(player, k, r); };
  const Percept warmth = [&](double q, NoiseStream& r) { return felt_heat_flow(player, q, r); };
  const Percept speed = [&](double v, NoiseStream& r) { return seen_speed_m_s(player, v, r); };
  const Percept distance = [&](double d, NoiseStream& r) { return heard_place(player, {0, 0, d}, r).distance_m; };
  using enum Evidence;
  std::vector<CheckResult> results{
      threshold("force", force, 2, player.force_weber, 0.05, 0.15, "Jones 2000; Pang, Tan and Durlach 1991",
                kUnverified, n, noise),
      threshold("stiffness", stiffness, 300, player.stiffness_weber, 0.08, 0.25,
                "0.08 (fixed displacement) to 0.23 (free exploration)", kUnverified, n, noise),
      threshold("heat flow", warmth, 1000, player.thermal_weber, 0.3, 0.6,
                "Bergmann Tiest and Kappers 2009, APP 71:481 (0.43)", kVerified, n, noise),
      threshold("seen speed", speed, 0.3, player.visual_speed_weber, 0.04, 0.2,
                "McKee 1981; de Bruyn and Orban 1988", kUnverified, n, noise),
      threshold("heard distance", distance, 1, player.distance_weber, 0.2, 0.5, "Zahorik 2002", kUnverified, n,
                noise)};
  // The scatter of a pointed azimuth in front, apart from confusions, and of a felt direction.
  double azimuth = 0, direction = 0;
  PlayerParameters sure = player;
  sure.front_back_confusion = 0;
  const int draws = 4 * n;
  for (int i = 0; i < draws; ++i) {
    azimuth += std::pow(heard_place(sure, {}, noise).azimuth_deg, 2) / draws;
    const auto felt = felt_force_N(player, Eigen::Vector3d(0, 0, 2), noise);
    const double angle_deg = felt ? std::atan2(felt->head<2>().norm(), felt->z()) * 180 / std::numbers::pi : 180;
    direction += angle_deg * angle_deg / draws;
  }
  const double slack = 3 / std::sqrt(2.0 * draws);  // three standard errors of a standard deviation
  results.push_back({8, "scatter of a heard azimuth", "degree", std::sqrt(azimuth), 2 * (1 - slack),
                     8 * (1 + slack), "3.6 in front", "Blauert 1997, Spatial Hearing", kUnverified});
  results.push_back({8, "scatter of a felt direction", "degree", std::sqrt(direction), 12 * (1 - slack),
                     35 * (1 + slack), "20-30", "Barbagli et al. 2006, ACM TAP 3:125", kUnverified});
  return results;
}

std::vector<CheckResult> check_recalibration(const PlayerParameters& player, std::uint64_t seed,
                                             const CheckEffort& effort) {
  // 60 taps whose effect is 100 ms later than in daily life; then: was the effect before or after the tap?
  constexpr int kTaps = 60;
  constexpr double kAdded_s = 0.1, kOrderSd_s = 0.04;  // of one judgement of order: 20-60 ms at 75 %
  const int trials = trials_of(1500, effort);
  const auto equality_s = [&](double added_s, std::uint64_t stream) {
    NoiseStream noise(sync::mixed(seed, kRecalibrationStream), stream);
    const DelayBeliefDef def{player.touch_latency_s, 0, player.adaptation_rate, player.perceptual_adaptation};
    DelayBelief belief(def);
    for (int i = 0; i < kTaps; ++i) belief.observe(def.natural_s + added_s + noise.normal(kOrderSd_s), kOrderSd_s);
    std::vector<Level> levels;
    for (double soa = -0.15; soa <= 0.2501; soa += 0.025) {
      Level level{soa, 0, static_cast<double>(trials)};
      for (int i = 0; i < trials; ++i)
        level.yes += soa + def.natural_s + noise.normal(kOrderSd_s) > belief.believed_s();
      levels.push_back(level);
    }
    return fit_normal(levels).mean;
  };
  // The mean over blocks: a block's own shift depends on its judgements.
  double shift_ms = 0;
  constexpr int kBlocks = 12;
  for (std::uint64_t block = 0; block < kBlocks; ++block)
    shift_ms += 1e3 * (equality_s(kAdded_s, 2 * block) - equality_s(0, 2 * block + 1)) / kBlocks;
  const double larger = expected_recalibration_s(player) / expected_recalibration_s({});
  return {{9, "shift of simultaneity after 60 taps with 100 ms", "ms", shift_ms, 10 * larger, 35 * larger, "about 20",
           "Sugano, Keetels and Vroomen 2012, Frontiers in Psychology 3:246", Evidence::kVerified}};
}

}  // namespace tactus::observer
