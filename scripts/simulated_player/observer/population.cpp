#include "scripts/simulated_player/observer/population.h"

#include <algorithm>
#include <cmath>

#include "scripts/simulated_player/observer/sobol.h"
#include "sync/random/keyed_random.h"

namespace tactus::observer {
namespace {

using P = PlayerParameters;
constexpr double kFive = 1.6448536269514722;  // normal quantile of 95 %
constexpr double kLatencyCorrelation = 0.6, kNoiseCorrelation = 0.3;

// Distribution function of the beta distribution with both parameters 4: a polynomial.
double beta44_cdf(double x) { return x * x * x * x * (35 - 84 * x + 70 * x * x - 20 * x * x * x); }

double beta44_quantile(double u) {
  double low = 0, high = 1;
  for (int i = 0; i < 60; ++i) (beta44_cdf((low + high) / 2) < u ? low : high) = (low + high) / 2;
  return (low + high) / 2;
}

double published_value(const ParameterRange& r, double u) {
  const double z = sync::normal_quantile(u);
  switch (r.spread) {
    case Spread::kLogNormal: return r.centre * std::pow(z < 0 ? r.centre / r.low : r.high / r.centre, z / kFive);
    case Spread::kUniform: return r.low + (u - 0.05) / 0.9 * (r.high - r.low);
    case Spread::kLogUniform: return r.low * std::pow(r.high / r.low, (u - 0.05) / 0.9);
    case Spread::kNormal: return r.centre + z / kFive * (r.high - r.centre);
    case Spread::kBeta44: return beta44_quantile(u);
    case Spread::kPiecewise:
      return u < 0.5 ? r.low + (u - 0.05) / 0.45 * (r.centre - r.low)
                     : r.centre + (u - 0.5) / 0.45 * (r.high - r.centre);
  }
  return r.centre;
}

// Properties 1 to 17.
std::vector<ParameterRange> ranges_of_the_senses() {
  using enum Evidence;
  using enum Spread;
  using enum Group;
  return {
      {"visual latency", 1, &P::visual_latency_s, "ms", 1e-3, 95, 120, 170, kLogNormal, kLatency, kVerified,
       "Cluff, Crevecoeur and Scott 2015, Vision Research 110:215 (about 100 ms to muscle activity); range: "
       "design"},
      {"touch latency", 2, &P::touch_latency_s, "ms", 1e-3, 50, 65, 90, kLogNormal, kLatency, kVerified,
       "Cluff, Crevecoeur and Scott 2015 (about 60 ms); range: design"},
      {"auditory latency", 3, &P::auditory_latency_s, "ms", 1e-3, 80, 110, 160, kLogNormal, kLatency, kDesign,
       "no measured value found; classic reaction times are 140-160 ms"},
      {"cold latency", 4, &P::cold_latency_s, "s", 1, 0.3, 0.4, 0.6, kLogNormal, kLatency, kUnverified,
       "reaction to cold, 0.3-0.5 s"},
      {"warm latency", 4, &P::warm_latency_s, "s", 1, 0.5, 0.7, 1.2, kLogNormal, kLatency, kUnverified,
       "reaction to warmth, 0.5-0.9 s"},
      {"muscle time constant", 5, &P::muscle_s, "ms", 1e-3, 30, 40, 60, kLogNormal, kNone, kVerified,
       "Todorov 2005, Neural Computation 17:1084 (two poles of 40 ms, read in public code); range: design"},
      {"error of the believed delay", 6, &P::initial_delay_error_s, "ms", 1e-3, -32.9, 0, 32.9, kNormal, kNone,
       kDesign, "normal, standard deviation 20 ms"},
      {"adaptation rate", 7, &P::adaptation_rate, "1", 1, 0.02, 0.063, 0.2, kLogUniform, kNone, kDesign,
       "complete within 60 taps: Sugano, Keetels and Vroomen 2012"},
      {"motor adaptation", 7, &P::motor_adaptation, "1", 1, 0.2, 0.55, 0.9, kUniform, kNone, kDesign,
       "larger than perceptual: Beech, Stanton Fraser and Gilchrist 2025, Journal of Vision 25(6):8"},
      {"perceptual adaptation", 7, &P::perceptual_adaptation, "1", 1, 0.1, 0.2, 0.3, kUniform, kNone, kVerified,
       "Sugano, Keetels and Vroomen 2012, Frontiers in Psychology 3:246 (20 ms of 100 ms); range: design"},
      {"visual noise", 8, &P::visual_sd_deg, "degree", 1, 0.06, 0.12, 0.3, kLogNormal, kNoise, kUnverified,
       "direction of a seen point"},
      {"eccentricity E2", 9, &P::visual_e2_deg, "degree", 1, 2, 3, 6, kLogNormal, kNone, kUnverified,
       "doubling eccentricity"},
      {"visual speed Weber", 10, &P::visual_speed_weber, "1", 1, 0.04, 0.08, 0.2, kLogNormal, kNoise, kUnverified,
       "McKee 1981; de Bruyn and Orban 1988"},
      {"proprioceptive noise", 11, &P::proprioceptive_sd_m, "mm", 1e-3, 5, 10, 20, kLogNormal, kNoise, kVerified,
       "joint angles 0.6-1.1 degrees: van Beers, Sittig and Denier van der Gon 1998, Experimental Brain Research "
       "122:367"},
      {"proprioceptive bias", 11, &P::proprioceptive_bias_m, "mm", 1e-3, 5, 15, 35, kLogNormal, kNone, kUnverified,
       "individual map of 10-30 mm without sight"},
      {"force Weber", 12, &P::force_weber, "1", 1, 0.05, 0.09, 0.15, kLogNormal, kNoise, kUnverified,
       "Jones 2000; Pang, Tan and Durlach 1991"},
      {"force floor", 12, &P::force_floor_N, "N", 1, 0.05, 0.1, 0.3, kLogNormal, kNone, kUnverified,
       "through a held tool"},
      {"force direction noise", 13, &P::force_direction_sd_deg, "degree", 1, 12, 22, 35, kLogNormal, kNoise,
       kUnverified, "Barbagli, Salisbury, Ho, Spence and Tan 2006, ACM TAP 3:125"},
      {"stiffness Weber", 14, &P::stiffness_weber, "1", 1, 0.08, 0.15, 0.25, kLogNormal, kNoise, kUnverified,
       "0.08 (fixed displacement) to 0.23 (free exploration)"},
      {"azimuth noise", 15, &P::azimuth_sd_deg, "degree", 1, 2, 4, 8, kLogNormal, kNoise, kUnverified,
       "Blauert 1997, Spatial Hearing: 3.6 degrees in front"},
      {"elevation factor", 15, &P::elevation_factor, "1", 1, 1.5, 2, 3, kLogNormal, kNone, kSecondHand,
       "Makous and Middlebrooks 1990"},
      {"auditory distance Weber", 15, &P::distance_weber, "1", 1, 0.2, 0.3, 0.5, kLogNormal, kNoise, kUnverified,
       "Zahorik 2002"},
      {"front-back confusion", 15, &P::front_back_confusion, "%", 1e-2, 1, 5, 20, kLogNormal, kNone, kUnverified,
       "Wenzel, Arruda, Kistler and Wightman 1993"},
      {"thermal Weber", 16, &P::thermal_weber, "1", 1, 0.3, 0.43, 0.6, kLogNormal, kNoise, kVerified,
       "Bergmann Tiest and Kappers 2009, Attention, Perception & Psychophysics 71:481 (43 %); range: design"},
      {"prior of a common cause", 17, &P::common_cause, "1", 1, 0, 0.5, 1, kBeta44, kNone, kDesign,
       "beta(4, 4); 0.28 is usually quoted for Koerding et al. 2007 (unverified)"}};
}

// Properties 18 to 25.
std::vector<ParameterRange> ranges_of_movement() {
  using enum Evidence;
  using enum Spread;
  using enum Group;
  return {
      {"assumed process noise", 18, &P::process_noise_m2_s, "m^2/s", 1, 1e-4, 1e-3, 1e-2, kLogNormal, kNone,
       kDesign, "structure: Crevecoeur, Munoz and Scott 2016, Journal of Neuroscience 36:8598"},
      {"motor noise, share", 19, &P::motor_noise_share, "1", 1, 0.03, 0.1, 0.2, kLogNormal, kNoise, kVerified,
       "van Beers, Haggard and Wolpert 2004, Journal of Neurophysiology 91:1050 (0.103, read in public code); "
       "range: design"},
      {"motor noise, constant", 19, &P::motor_noise_N, "N", 1, 0.02, 0.06, 0.185, kLogNormal, kNoise, kDesign,
       "van Beers et al. 2004 (0.185 of a normalised activation; the unit N is a choice)"},
      {"arm stiffness", 20, &P::stiffness_N_m, "N/m", 1, 100, 300, 800, kLogNormal, kNone, kUnverified,
       "Mussa-Ivaldi, Hogan and Bizzi 1985; Tsuji et al. 1995"},
      {"rise of stiffness with load", 20, &P::stiffness_rise_1_m, "1/m", 1, 0, 2, 6, kPiecewise, kNone,
       kUnverified, "linear in torque: Tee, Burdet, Chew and Milner 2004"},
      {"damping ratio", 20, &P::damping_ratio, "1", 1, 0.2, 0.4, 0.7, kLogNormal, kNone, kUnverified,
       "Tsuji et al. 1995"},
      {"effective mass", 20, &P::mass_kg, "kg", 1, 0.7, 1.2, 2, kLogNormal, kNone, kUnverified,
       "Tsuji et al. 1995"},
      {"pace", 21, &P::pace_s_bit, "ms/bit", 1e-3, 120, 200, 300, kLogNormal, kNone, kSecondHand,
       "3.7-4.9 bit/s with a mouse: Soukoreff and MacKenzie 2004"},
      {"caution", 22, &P::caution, "1", 1, 0.3, 1, 3, kLogUniform, kNone, kDesign,
       "cost of an error against time"},
      {"wait threshold", 23, &P::wait_threshold_s, "s", 1, 0.3, 0.55, 0.8, kUniform, kNone, kDesign,
       "move and wait: Sheridan and Ferrell 1963; Ferrell 1965 (second hand)"},
      {"lapse", 24, &P::lapse, "1", 1, 0.005, 0.02, 0.06, kLogNormal, kNone, kDesign, "missed percepts"},
      {"search spread", 25, &P::search_spread, "1", 1, 0.5, 1, 2, kLogNormal, kNone, kDesign,
       "factor on the prior of each task"}};
}

}  // namespace

const char* evidence_name(Evidence evidence) {
  switch (evidence) {
    case Evidence::kVerified: return "verified";
    case Evidence::kSecondHand: return "second hand";
    case Evidence::kUnverified: return "unverified";
    case Evidence::kDesign: return "design";
  }
  return "design";
}

const std::vector<ParameterRange>& parameter_ranges() {
  static const std::vector<ParameterRange> ranges = [] {
    std::vector<ParameterRange> all = ranges_of_the_senses();
    const std::vector<ParameterRange> movement = ranges_of_movement();
    all.insert(all.end(), movement.begin(), movement.end());
    return all;
  }();
  return ranges;
}

double value_at(const ParameterRange& range, double u) {
  const double inside = std::clamp(0.05 + 0.9 * u, 0.05, 0.95);
  return range.to_si * published_value(range, inside);
}

PlayerParameters player_of(std::uint32_t index, std::uint64_t seed) {
  const auto& ranges = parameter_ranges();
  const int count = static_cast<int>(ranges.size());
  const auto point = scrambled_sobol_point(index, count + 2, seed);
  const auto at = [&](int i) { return sync::normal_quantile(point[static_cast<std::size_t>(i)]); };
  const double slowness = at(count), noisiness = at(count + 1);
  PlayerParameters player;
  for (int i = 0; i < count; ++i) {
    const ParameterRange& range = ranges[static_cast<std::size_t>(i)];
    double z = at(i);
    if (range.group == Group::kLatency)
      z = std::sqrt(kLatencyCorrelation) * slowness + std::sqrt(1 - kLatencyCorrelation) * z;
    if (range.group == Group::kNoise)
      z = std::sqrt(kNoiseCorrelation) * noisiness + std::sqrt(1 - kNoiseCorrelation) * z;
    player.*range.field = value_at(range, sync::normal_cdf(z));
  }
  return player;
}

}  // namespace tactus::observer
